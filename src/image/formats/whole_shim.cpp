#include <cmath>
#include <cstdlib>
#include <cstring>

#include "image/formats/input.hpp"
#include "image/formats/whole.h"

namespace formats
{
namespace
{

/* PNG and JPEG have one part, which is decoded at once when the first rows are asked for. */
class whole_input : public ImageInput
{
  public:
    explicit whole_input(bool is_png) : png(is_png)
    {
    }
    ~whole_input() override
    {
        std::free(w.data);
    }
    const char *format_name() const override
    {
        return png ? "png" : "jpeg";
    }
    bool open(const std::string &name, ImageSpec &spec) override
    {
        path = name;
        if (!decode(false))
            return false;
        current = ImageSpec(w.width, w.height, w.channels, w.bytes == 2 ? TypeDesc::UINT16 : TypeDesc::UINT8);
        if (w.channels == 2) {
            current.channelnames = {"Y", "A"};
            current.alpha_channel = 1;
        }
        if (current.alpha_channel >= 0)
            current.attribute("oiio:UnassociatedAlpha", 1);
        if (w.orientation)
            current.attribute("Orientation", w.orientation);
        if (w.gamma > 0)
            current.attribute("oiio:Gamma", float(std::round(100 * w.gamma) / 100));
        else
            current.attribute("oiio:ColorSpace", std::string("sRGB"));
        spec = current;
        return true;
    }

  protected:
    bool rows(int first, int end, int from, int to, TypeDesc, void *out) override
    {
        if (!w.data && !decode(true))
            return false;
        const size_t size = size_t(w.bytes), all = size_t(w.channels) * size, some = size_t(to - from) * size;
        const size_t pixels = size_t(end - first) * size_t(w.width);
        const unsigned char *in = w.data + size_t(first) * size_t(w.width) * all + size_t(from) * size;
        for (size_t i = 0; i < pixels; i++)
            std::memcpy(static_cast<unsigned char *>(out) + i * some, in + i * all, some);
        return true;
    }

  private:
    bool decode(bool with_data)
    {
        return (png ? whole_png : whole_jpeg)(path.c_str(), with_data, &w) || wrong(w.error);
    }
    const bool png;
    std::string path;
    struct whole w = {};
};

} // namespace

std::unique_ptr<ImageInput> make_png()
{
    return std::unique_ptr<ImageInput>(new whole_input(true));
}

std::unique_ptr<ImageInput> make_jpeg()
{
    return std::unique_ptr<ImageInput>(new whole_input(false));
}

} // namespace formats
