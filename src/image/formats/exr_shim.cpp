#include <algorithm>
#include <climits>
#include <strings.h>
#include <tuple>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfThreading.h>
#include <ImfTileDescriptionAttribute.h>

#include "image/formats/input.hpp"

namespace formats
{
namespace
{

struct channel {
    std::string name, layer, suffix;
    Imf::Channel of;
    int place = INT_MAX; /* among the channels of its layer with known names */
};

bool is(const std::string &a, const char *b)
{
    return strcasecmp(a.c_str(), b) == 0;
}

/* The order in which OpenImageIO numbers channels: by layer, then known names, then others by name. Beside X, Y is a coordinate. */
std::vector<channel> in_order(const Imf::ChannelList &list)
{
    static const std::vector<const char *> colours = {"R",    "Red",  "G",  "Green", "B",     "Blue", "Y",
                                                      "real", "imag", "A",  "Alpha", "AR",    "RA",   "AG",
                                                      "GA",   "AB",   "BA", "Z",     "Depth", "Zback"};
    static const std::vector<const char *> places = {"R",  "Red", "G",    "Green", "B",  "Blue",  "X",
                                                     "Y",  "Z",   "real", "imag",  "A",  "Alpha", "AR",
                                                     "RA", "AG",  "GA",   "AB",    "BA", "Depth", "Zback"};
    std::vector<channel> all;
    for (auto c = list.begin(); c != list.end(); ++c) {
        channel one;
        one.name = c.name();
        one.of = c.channel();
        const size_t dot = one.name.rfind('.');
        one.layer = dot == std::string::npos ? "" : one.name.substr(0, dot);
        one.suffix = dot == std::string::npos ? one.name : one.name.substr(dot + 1);
        all.push_back(one);
    }
    for (channel &c : all) {
        bool x = false, y_or_z = false;
        for (const channel &other : all)
            if (other.layer == c.layer) {
                x |= is(other.suffix, "X");
                y_or_z |= is(other.suffix, "Y") || is(other.suffix, "Z");
            }
        const std::vector<const char *> &known = x && y_or_z ? places : colours;
        for (size_t i = 0; i < known.size() && c.place == INT_MAX; i++)
            if (is(c.suffix, known[i]))
                c.place = int(i);
    }
    std::sort(all.begin(), all.end(), [](const channel &a, const channel &b) {
        return std::tie(a.layer, a.place, a.suffix) < std::tie(b.layer, b.place, b.suffix);
    });
    return all;
}

class exr_input : public ImageInput
{
  public:
    const char *format_name() const override
    {
        return "openexr";
    }
    bool open(const std::string &path, ImageSpec &spec) override
    {
        Imf::setGlobalThreadCount(0);
        try {
            file.reset(new Imf::MultiPartInputFile(path.c_str(), 0));
        } catch (const std::exception &e) {
            return wrong(e.what());
        }
        if (!describe(0))
            return false;
        spec = current;
        return true;
    }
    bool seek_subimage(int wanted, int) override
    {
        if (wanted < 0 || wanted >= file->parts())
            return wrong("no such part");
        return wanted == part && !current.channelnames.empty() ? true : describe(wanted);
    }

  protected:
    /* Rows may be asked for beyond the data window's own, by whole rows of tiles only. */
    bool rows(int first, int end, int from, int to, TypeDesc type, void *out) override
    {
        try {
            const size_t size = type.size(), pixel = size * size_t(to - from),
                         row = pixel * size_t(current.width);
            Imf::FrameBuffer frame;
            for (int c = from; c < to; c++) {
                char *at = static_cast<char *>(out) + size_t(c - from) * size;
                frame.insert(current.channelnames[size_t(c)].c_str(),
                             Imf::Slice::Make(type.basetype == TypeDesc::UINT32 ? Imf::UINT : Imf::FLOAT, at,
                                              Imath::V2i(current.x, first), current.width, end - first, pixel,
                                              row));
            }
            Imf::InputPart in(*file, part);
            in.setFrameBuffer(frame);
            in.readPixels(first, end - 1);
            return true;
        } catch (const std::exception &e) {
            return wrong(e.what());
        }
    }

  private:
    bool describe(int wanted)
    {
        const Imf::Header &head = file->header(wanted);
        const Imath::Box2i data = head.dataWindow(), shown = head.displayWindow();
        const std::vector<channel> all = in_order(head.channels());
        const int64_t size[] = {int64_t(data.max.x) - data.min.x + 1, int64_t(data.max.y) - data.min.y + 1,
                                int64_t(shown.max.x) - shown.min.x + 1,
                                int64_t(shown.max.y) - shown.min.y + 1};
        for (const int64_t n : size)
            if (n < 1 || n > INT_MAX)
                return wrong("its windows are damaged");
        current = ImageSpec();
        current.x = data.min.x;
        current.y = data.min.y;
        current.width = int(size[0]);
        current.height = int(size[1]);
        current.full_x = shown.min.x;
        current.full_y = shown.min.y;
        current.full_width = int(size[2]);
        current.full_height = int(size[3]);
        current.nchannels = int(all.size());
        current.deep = head.hasType() && Imf::isDeepData(head.type());
        if (head.hasTileDescription()) {
            current.tile_width = int(head.tileDescription().xSize);
            current.tile_height = int(head.tileDescription().ySize);
        }
        for (const channel &c : all) {
            if (c.of.xSampling != 1 || c.of.ySampling != 1)
                return wrong("channel " + c.name + " has fewer pixels than the picture (subsampling)");
            current.channelnames.push_back(c.name);
            current.channelformats.push_back(c.of.type == Imf::UINT   ? TypeDesc::UINT32
                                             : c.of.type == Imf::HALF ? TypeDesc::HALF
                                                                      : TypeDesc::FLOAT);
            if (current.alpha_channel < 0 && (is(c.suffix, "A") || is(c.suffix, "Alpha")))
                current.alpha_channel = int(current.channelnames.size()) - 1;
        }
        current.format = all.empty() ? TypeDesc(TypeDesc::FLOAT) : current.channelformats[0];
        bool same = true;
        for (const TypeDesc &t : current.channelformats)
            same &= t.basetype == current.format.basetype;
        if (same)
            current.channelformats.clear();
        if (head.hasName())
            current.attribute("oiio:subimagename", head.name());
        part = wanted;
        return true;
    }

    std::unique_ptr<Imf::MultiPartInputFile> file;
};

} // namespace

std::unique_ptr<ImageInput> make_exr()
{
    return std::unique_ptr<ImageInput>(new exr_input);
}

} // namespace formats
