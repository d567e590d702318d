#include "image/formats/input.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace formats
{

size_t TypeDesc::size() const
{
    static const size_t bytes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    return bytes[basetype];
}

ImageSpec::ImageSpec(int w, int h, int channels, TypeDesc type)
    : width(w), height(h), full_width(w), full_height(h), nchannels(channels), format(type)
{
    default_channel_names();
}

void ImageSpec::default_channel_names()
{
    static const char *const names[] = {"R", "G", "B", "A"};
    channelnames.clear();
    for (int i = 0; i < nchannels; i++)
        channelnames.push_back(i < 4 ? names[i] : "channel" + std::to_string(i));
    alpha_channel = nchannels == 4 ? 3 : -1;
    if (nchannels == 1)
        channelnames[0] = "Y";
}

int ImageSpec::get_int_attribute(const std::string &name, int without) const
{
    const auto found = number.find(name);
    return found == number.end() ? without : int(found->second);
}

float ImageSpec::get_float_attribute(const std::string &name, float without) const
{
    const auto found = number.find(name);
    return found == number.end() ? without : float(found->second);
}

std::string ImageSpec::get_string_attribute(const std::string &name, const std::string &without) const
{
    const auto found = text.find(name);
    return found == text.end() ? without : found->second;
}

static std::string last;

std::string geterror()
{
    std::string e;
    e.swap(last);
    return e;
}

std::unique_ptr<ImageInput> ImageInput::open(const std::string &path, const ImageSpec *)
{
    unsigned char magic[8] = {0};
    std::unique_ptr<ImageInput> in;
    ImageSpec spec;
    FILE *f = std::fopen(path.c_str(), "rb");
    if (!f) {
        last = std::strerror(errno);
        return in;
    }
    const size_t n = std::fread(magic, 1, sizeof magic, f);
    std::fclose(f);
    if (n == 8 && std::memcmp(magic, "\x89PNG\r\n\x1a\n", 8) == 0)
        in = make_png();
    else if (n >= 3 && std::memcmp(magic, "\xff\xd8\xff", 3) == 0)
        in = make_jpeg();
    else if (n >= 4 && (std::memcmp(magic, "II*\0", 4) == 0 || std::memcmp(magic, "MM\0*", 4) == 0 ||
                        std::memcmp(magic, "II+\0", 4) == 0 || std::memcmp(magic, "MM\0+", 4) == 0))
        in = make_tiff();
    else if (n >= 4 && std::memcmp(magic, "\x76\x2f\x31\x01", 4) == 0)
        in = make_exr();
    else
        last = "this hoodoo reads PNG, JPEG, TIFF, OpenEXR and PGM; convert the file to one of these";
    if (in && !in->open(path, spec)) {
        last = in->geterror();
        in.reset();
    }
    return in;
}

std::unique_ptr<ImageInput> ImageInput::create(const char *format)
{
    return std::strcmp(format, "tiff") == 0 ? make_tiff() : nullptr;
}

bool ImageInput::seek_subimage(int wanted, int)
{
    return wanted == 0 || wrong("it has one part");
}

bool ImageInput::read_scanlines(int, int, int first, int end, int, int from, int to, TypeDesc type, void *out)
{
    return rows(first, end, from, to, type, out);
}

bool ImageInput::read_tiles(int, int, int, int, int first, int end, int, int, int from, int to, TypeDesc type,
                            void *out)
{
    return rows(first, end, from, to, type, out);
}

std::string ImageInput::geterror()
{
    std::string e;
    e.swap(error);
    return e;
}

bool ImageInput::wrong(const std::string &why)
{
    error = why;
    return false;
}

} // namespace formats
