/* PNG, JPEG, TIFF and OpenEXR by their own libraries, behind the part of OpenImageIO's interface that decode_shim.cpp uses. Names and
 * meanings are OpenImageIO's: so are the order and names of channels, and values of fewer bits, which are scaled to the full range of
 * the next larger type. Linked into the hoodoo-read-image of a bundle only.
 *
 * Differences   Images with inks (CMYK) are refused; there are no other formats.
 * Errors        Functions that return bool or a null pointer leave their message for geterror().
 */
#ifndef HOODOO_IMAGE_FORMATS_INPUT_HPP
#define HOODOO_IMAGE_FORMATS_INPUT_HPP

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace formats
{

struct TypeDesc {
    enum BASETYPE { UNKNOWN, UINT8, INT8, UINT16, INT16, UINT32, INT32, UINT64, INT64, HALF, FLOAT, DOUBLE };
    BASETYPE basetype;
    TypeDesc(BASETYPE type = UNKNOWN) : basetype(type)
    {
    }
    size_t size() const;
};

class ImageSpec
{
  public:
    int width = 0, height = 0, depth = 1, x = 0, y = 0, z = 0;
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0;
    int tile_width = 0, tile_height = 0; /* 0: no tiles */
    int nchannels = 0, alpha_channel = -1;
    bool deep = false;
    TypeDesc format;
    std::vector<TypeDesc> channelformats; /* empty: all are of `format` */
    std::vector<std::string> channelnames;

    ImageSpec() = default;
    ImageSpec(int w, int h, int channels, TypeDesc type);
    TypeDesc channelformat(int channel) const
    {
        return channelformats.empty() ? format : channelformats[size_t(channel)];
    }
    /* R, G, B, A; Y if there is one channel, Y and A if there are two. */
    void default_channel_names();
    void attribute(const std::string &name, int value)
    {
        number[name] = value;
    }
    void attribute(const std::string &name, float value)
    {
        number[name] = double(value);
    }
    void attribute(const std::string &name, const std::string &value)
    {
        text[name] = value;
    }
    int get_int_attribute(const std::string &name, int without = 0) const;
    float get_float_attribute(const std::string &name, float without = 0) const;
    std::string get_string_attribute(const std::string &name, const std::string &without = "") const;

  private:
    std::map<std::string, double> number;
    std::map<std::string, std::string> text;
};

class ImageInput
{
  public:
    /* Opens a file, whose first bytes tell its format. */
    static std::unique_ptr<ImageInput> open(const std::string &path, const ImageSpec *config);
    /* "tiff" only: an input that open() below opens. */
    static std::unique_ptr<ImageInput> create(const char *format);

    virtual ~ImageInput() = default;
    virtual const char *format_name() const = 0;
    virtual bool open(const std::string &path, ImageSpec &spec) = 0;
    bool open(const std::string &path, ImageSpec &spec, const ImageSpec &)
    {
        return open(path, spec);
    }
    /* Makes a part the current one; `mip` is 0. */
    virtual bool seek_subimage(int part, int mip);
    const ImageSpec &spec() const
    {
        return current;
    }
    /* Decode rows [first, end) of the current part, channels [from, to), as numbers of `type`, which is that of the channels, or FLOAT
     * for HALF: out[row][column][channel]. */
    bool read_scanlines(int part, int mip, int first, int end, int z, int from, int to, TypeDesc type,
                        void *out);
    bool read_tiles(int part, int mip, int x_first, int x_end, int first, int end, int z_first, int z_end,
                    int from, int to, TypeDesc type, void *out);
    std::string geterror();

  protected:
    virtual bool rows(int first, int end, int from, int to, TypeDesc type, void *out) = 0;
    bool wrong(const std::string &why);
    ImageSpec current;
    int part = 0;

  private:
    std::string error;
};

/* The message of ImageInput::open(path, config). */
std::string geterror();
inline void attribute(const char *, int)
{
}

std::unique_ptr<ImageInput> make_png();
std::unique_ptr<ImageInput> make_jpeg();
std::unique_ptr<ImageInput> make_tiff();
std::unique_ptr<ImageInput> make_exr();

} // namespace formats

#endif
