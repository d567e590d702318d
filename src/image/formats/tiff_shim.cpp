#include <algorithm>
#include <cstring>

#include <tiffio.h>

#include "image/formats/input.hpp"

namespace formats
{
namespace
{

std::string message; /* of libtiff */

void on_error(const char *, const char *format, va_list values)
{
    char text[256];
    std::vsnprintf(text, sizeof text, format, values);
    message = text;
}

class tiff_input : public ImageInput
{
  public:
    ~tiff_input() override
    {
        if (tiff)
            TIFFClose(tiff);
    }
    const char *format_name() const override
    {
        return "tiff";
    }
    bool open(const std::string &path, ImageSpec &spec) override
    {
        TIFFSetErrorHandler(on_error);
        TIFFSetWarningHandler(nullptr);
        message.clear();
        tiff = TIFFOpen(path.c_str(), "r");
        if (!tiff)
            return wrong(message);
        if (!describe())
            return false;
        spec = current;
        return true;
    }
    bool seek_subimage(int wanted, int) override
    {
        if (wanted == part)
            return true;
        if (wanted < 0 || wanted > 65535 || !TIFFSetDirectory(tiff, tdir_t(wanted))) {
            TIFFSetDirectory(tiff, tdir_t(part));
            return wrong("no such part");
        }
        part = wanted;
        stored_first = stored_end = 0;
        return describe();
    }

  protected:
    bool rows(int first, int end, int from, int to, TypeDesc, void *out) override
    {
        const size_t size = current.format.basetype == TypeDesc::HALF ? 4 : current.format.size();
        const size_t some = size_t(to - from) * size, all = size_t(current.nchannels) * size;
        unsigned char *next = static_cast<unsigned char *>(out);
        for (int y = first; y < end; y++) {
            if ((y < stored_first || y >= stored_end) && !decode(y))
                return wrong(message.empty() ? "its pixel data is truncated" : message);
            const unsigned char *in =
                store.data() + size_t(y - stored_first) * size_t(current.width) * all + size_t(from) * size;
            for (int x = 0; x < current.width; x++, next += some, in += all)
                std::memcpy(next, in, some);
        }
        return true;
    }

  private:
    /* ---- the head of a part */

    bool choose_type(int form)
    {
        static const struct {
            unsigned bits;
            TypeDesc::BASETYPE plain, with_sign, real;
        } types[] = {{8, TypeDesc::UINT8, TypeDesc::INT8, TypeDesc::UNKNOWN},
                     {16, TypeDesc::UINT16, TypeDesc::INT16, TypeDesc::HALF},
                     {32, TypeDesc::UINT32, TypeDesc::INT32, TypeDesc::FLOAT},
                     {64, TypeDesc::UNKNOWN, TypeDesc::UNKNOWN, TypeDesc::DOUBLE}};
        current.format = TypeDesc::UNKNOWN;
        for (const auto &t : types)
            if (bits > t.bits / 2 && bits <= t.bits && (t.bits > 8 || bits > 0))
                current.format = form == SAMPLEFORMAT_UINT  ? t.plain
                                 : form == SAMPLEFORMAT_INT ? t.with_sign
                                                            : t.real;
        if (bits >= 1 && bits <= 4 && form == SAMPLEFORMAT_UINT)
            current.format = TypeDesc::UINT8;
        /* Numbers of odd sizes are unsigned integers of at most 16 bits. */
        const bool odd = bits != 8 && bits != 16 && bits != 32 && bits != 64;
        return current.format.basetype != TypeDesc::UNKNOWN &&
               (!odd || (form == SAMPLEFORMAT_UINT && bits < 16));
    }

    bool describe()
    {
        uint32_t w = 0, h = 0, deep = 1, tile_w = 0, tile_h = 0;
        uint16_t samples = 1, form = SAMPLEFORMAT_UINT, plan = PLANARCONFIG_CONTIG, code = COMPRESSION_NONE,
                 turn = 0;
        char *name = nullptr;
        TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &w);
        TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &h);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_IMAGEDEPTH, &deep);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &form);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &plan);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &code);
        colour = samples == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
        TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &colour);
        if (w > INT32_MAX || h > INT32_MAX || !samples || samples > 4096)
            return wrong("its size is damaged");
        n_samples = samples;
        current = ImageSpec(int(w), int(h), samples, TypeDesc::UNKNOWN);
        current.depth = int(deep);
        if (!choose_type(form))
            return wrong("numbers of " + std::to_string(bits) + " bits in sample format " +
                         std::to_string(form) + " are not supported");
        if (samples == 2)
            current.channelnames = {"R", "G"};
        if (colour == PHOTOMETRIC_SEPARATED)
            return wrong("its colours are inks (CMYK); convert it to grey or to red, green and blue");
        separate = plan == PLANARCONFIG_SEPARATE && samples > 1;
        find_alpha();
        if (TIFFIsTiled(tiff)) {
            TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &tile_w);
            TIFFGetField(tiff, TIFFTAG_TILELENGTH, &tile_h);
            if (!tile_w || !tile_h || tile_w > INT32_MAX || tile_h > INT32_MAX)
                return wrong("the size of its tiles is damaged");
            current.tile_width = int(tile_w);
            current.tile_height = int(tile_h);
        }
        /* Colours that are not red, green and blue are converted by libtiff. */
        by_libtiff = (code == COMPRESSION_JPEG && samples != 3) || colour == PHOTOMETRIC_YCBCR ||
                     colour == PHOTOMETRIC_CIELAB || colour == PHOTOMETRIC_ICCLAB ||
                     colour == PHOTOMETRIC_ITULAB || colour == PHOTOMETRIC_LOGL ||
                     colour == PHOTOMETRIC_LOGLUV;
        if (by_libtiff)
            current.format = TypeDesc::UINT8;
        else if (colour == PHOTOMETRIC_PALETTE && !begin_palette())
            return wrong("its palette is damaged");
        else
            current.attribute("oiio:BitsPerSample", colour == PHOTOMETRIC_PALETTE ? 8 : int(bits));
        if (TIFFGetField(tiff, TIFFTAG_ORIENTATION, &turn))
            current.attribute("Orientation", int(turn));
        if (TIFFGetField(tiff, TIFFTAG_PAGENAME, &name) && name)
            current.attribute("PageName", std::string(name));
        return true;
    }

    void find_alpha()
    {
        uint16_t n = 0, *kind = nullptr;
        if (!TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &n, &kind) || !kind)
            return;
        const bool grey = colour == PHOTOMETRIC_MINISWHITE || colour == PHOTOMETRIC_MINISBLACK ||
                          colour == PHOTOMETRIC_PALETTE || colour == PHOTOMETRIC_MASK;
        for (int i = 0, c = grey ? 1 : 3; i < n && c < n_samples; i++, c++) {
            if (kind[i] == EXTRASAMPLE_ASSOCALPHA || kind[i] == EXTRASAMPLE_UNASSALPHA)
                current.alpha_channel = c;
            else if (current.alpha_channel == c) {
                current.channelnames[size_t(c)] = "channel" + std::to_string(c);
                current.alpha_channel = -1;
            }
            if (kind[i] == EXTRASAMPLE_UNASSALPHA)
                current.attribute("oiio:UnassociatedAlpha", 1);
        }
        if (current.alpha_channel < 0)
            return;
        current.channelnames[size_t(current.alpha_channel)] = "A";
        if (current.nchannels == 2 && current.alpha_channel == 1)
            current.channelnames[0] = "Y";
    }

    bool begin_palette()
    {
        uint16_t *r = nullptr, *g = nullptr, *b = nullptr;
        if (bits > 16 || n_samples != 1 || !TIFFGetField(tiff, TIFFTAG_COLORMAP, &r, &g, &b) || !r || !g ||
            !b)
            return false;
        const size_t n = size_t(1) << bits;
        palette.clear();
        for (size_t i = 0; i < n; i++)
            for (const uint16_t v : {r[i], g[i], b[i]})
                palette.push_back(static_cast<unsigned char>(v / 257));
        current.nchannels = 3;
        current.alpha_channel = -1;
        current.format = TypeDesc::UINT8;
        current.default_channel_names();
        return true;
    }

    /* ---- pixels: `store` holds the decoded rows [stored_first, stored_end) */

    bool decode(int y)
    {
        message.clear();
        if (by_libtiff)
            return decode_by_libtiff();
        uint32_t rows_in_strip = 0;
        TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &rows_in_strip);
        const int high = current.tile_height ? current.tile_height
                                             : int(std::min(rows_in_strip, uint32_t(current.height)));
        if (high < 1)
            return false;
        const int first = y / high * high,
                  end = int(std::min(int64_t(first) + high, int64_t(current.height)));
        const size_t size = current.format.basetype == TypeDesc::HALF ? 4 : current.format.size();
        stored_first = stored_end = 0;
        store.assign(size_t(end - first) * size_t(current.width) * size_t(current.nchannels) * size, 0);
        for (int plane = 0; plane < (separate ? n_samples : 1); plane++)
            if (current.tile_width ? !decode_tiles(first, end, plane) : !decode_strip(first, end, plane))
                return false;
        stored_first = first;
        stored_end = end;
        return true;
    }

    bool decode_strip(int first, int end, int plane)
    {
        const uint32_t strip = TIFFComputeStrip(tiff, uint32_t(first), uint16_t(plane));
        const size_t row = size_t(TIFFScanlineSize(tiff));
        const size_t wanted = row * size_t(end - first);
        coded.assign(wanted, 0);
        if (TIFFReadEncodedStrip(tiff, strip, coded.data(), tmsize_t(wanted)) != tmsize_t(wanted))
            return false;
        for (int y = first; y < end; y++)
            unpack(coded.data() + size_t(y - first) * row, 0, current.width, y - first, plane);
        return true;
    }

    bool decode_tiles(int first, int end, int plane)
    {
        const size_t bytes = size_t(TIFFTileSize(tiff)), row = size_t(TIFFTileRowSize(tiff));
        if (bytes < row * size_t(current.tile_height))
            return false;
        coded.assign(bytes, 0);
        for (int x = 0; x < current.width; x += std::min(current.tile_width, current.width - x)) {
            const uint32_t tile = TIFFComputeTile(tiff, uint32_t(x), uint32_t(first), 0, uint16_t(plane));
            if (TIFFReadEncodedTile(tiff, tile, coded.data(), tmsize_t(bytes)) != tmsize_t(bytes))
                return false;
            for (int y = first; y < end; y++)
                unpack(coded.data() + size_t(y - first) * row, x,
                       std::min(current.tile_width, current.width - x), y - first, plane);
        }
        return true;
    }

    /* The number at bit `at`, of at most 16 bits, the most significant first. */
    static unsigned bits_at(const unsigned char *in, size_t at, unsigned n)
    {
        unsigned v = 0;
        for (unsigned i = 0; i < n; i++, at++)
            v = v << 1 | (in[at / 8] >> (7 - at % 8) & 1u);
        return v;
    }

    static float half_to_float(uint16_t h)
    {
        const uint32_t sign = uint32_t(h & 0x8000) << 16, rest = h & 0x7fff;
        const float tiny = float(rest) * 5.9604644775390625e-8f; /* 2^-24 */
        uint32_t all =
            sign | (rest >= 0x7c00 ? 0x7f800000 | (rest & 0x3ff) << 13 : (rest << 13) + 0x38000000);
        if (rest < 0x400) {
            std::memcpy(&all, &tiny, 4);
            all |= sign;
        }
        float f;
        std::memcpy(&f, &all, 4);
        return f;
    }

    /* Puts `n` pixels of a coded row at column x of row y of the store. */
    void unpack(const unsigned char *in, int x, int n, int y, int plane)
    {
        const size_t per_pixel = separate ? 1 : size_t(n_samples), channels = size_t(current.nchannels);
        const size_t size = current.format.basetype == TypeDesc::HALF ? 4 : current.format.size();
        unsigned char *out =
            store.data() +
            ((size_t(y) * size_t(current.width) + size_t(x)) * channels + size_t(plane)) * size;
        if (colour == PHOTOMETRIC_PALETTE) {
            for (size_t i = 0; i < size_t(n); i++) {
                uint16_t index = 0;
                if (bits == 16)
                    std::memcpy(&index, in + 2 * i, 2);
                else
                    index = uint16_t(bits_at(in, i * bits, bits));
                std::memcpy(out + i * 3, &palette[size_t(index) * 3], 3);
            }
            return;
        }
        for (size_t i = 0; i < size_t(n) * per_pixel; i++) {
            unsigned char *to = out + (i / per_pixel * channels + i % per_pixel) * size;
            if (bits == 16 && current.format.basetype == TypeDesc::HALF) {
                uint16_t h;
                std::memcpy(&h, in + 2 * i, 2);
                const float f = half_to_float(h);
                std::memcpy(to, &f, 4);
            } else if (bits == 8 * size) {
                std::memcpy(to, in + i * size, size);
            } else {
                const unsigned most = (1u << bits) - 1, full = size == 1 ? 255 : 65535;
                const unsigned v = (bits_at(in, i * bits, bits) * full + most / 2) / most;
                const uint16_t wide = uint16_t(v);
                const uint8_t narrow = uint8_t(v);
                std::memcpy(to, size == 1 ? static_cast<const void *>(&narrow) : &wide, size);
            }
            if (colour == PHOTOMETRIC_MINISWHITE && size <= 2 && current.format.basetype != TypeDesc::HALF)
                for (size_t b = 0; b < size; b++)
                    to[b] = static_cast<unsigned char>(~to[b]);
        }
    }

    bool decode_by_libtiff()
    {
        const size_t n = size_t(current.width) * size_t(current.height), channels = size_t(current.nchannels);
        std::vector<uint32_t> pixel(n);
        if (!TIFFReadRGBAImageOriented(tiff, uint32_t(current.width), uint32_t(current.height), pixel.data(),
                                       ORIENTATION_TOPLEFT, 1))
            return false;
        store.resize(n * channels);
        for (size_t i = 0; i < n; i++)
            for (size_t c = 0; c < channels; c++)
                store[i * channels + c] = static_cast<unsigned char>(c < 4 ? pixel[i] >> 8 * c & 255 : 0);
        stored_first = 0;
        stored_end = current.height;
        return true;
    }

    TIFF *tiff = nullptr;
    uint16_t bits = 8, colour = PHOTOMETRIC_MINISBLACK;
    int n_samples = 1;
    bool separate = false, by_libtiff = false;
    std::vector<unsigned char> palette, coded, store;
    int stored_first = 0, stored_end = 0;
};

} // namespace

std::unique_ptr<ImageInput> make_tiff()
{
    return std::unique_ptr<ImageInput>(new tiff_input);
}

} // namespace formats
