#include "image/decode.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "image/library.hpp"

#include "image/band.hpp"
#include "image/choice.hpp"

namespace
{

enum { ROWS = 64 };

/* Scene-linear light from a stored value of a colour space. */
double light(double v, const std::string &space, double gamma)
{
    if (same(space, "sRGB"))
        return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    if (same(space, "Rec709"))
        return v < 0.081 ? v / 4.5 : std::pow((v + 0.099) / 1.099, 1 / 0.45);
    return gamma > 0 && gamma != 1 && v > 0 ? std::pow(v, gamma) : v;
}

/* ---- the picture */

class picture
{
  public:
    picture(OIIO::ImageInput &input, struct image_decoding *made, int input_part,
            const struct channels &chosen)
        : in(input), m(made), spec(input.spec()), part(input_part), c(chosen),
          space(spec.get_string_attribute("oiio:ColorSpace")),
          gamma(double(spec.get_float_attribute("oiio:Gamma", 1)))
    {
    }

    /* Sets size, data window and number format of the picture. */
    status begin()
    {
        const bool has_window = std::string(in.format_name()) == "openexr";
        m->width = uint64_t(has_window ? spec.full_width : spec.width);
        m->height = uint64_t(has_window ? spec.full_height : spec.height);
        m->left = has_window ? int64_t(spec.x) - spec.full_x : 0;
        m->top = has_window ? int64_t(spec.y) - spec.full_y : 0;
        m->orientation = spec.get_int_attribute("Orientation", m->hints.orientation);
        m->premultiplied = c.alpha >= 0 && !spec.get_int_attribute("oiio:UnassociatedAlpha", 0) && !is_data();
        const OIIO::TypeDesc type = type_of(spec, c.value[0]);
        m->white = white_of(type);
        m->is_integer = m->white > 0;
        /* OpenImageIO scales values of fewer bits up to the full range of their type. */
        const int bits = spec.get_int_attribute("oiio:BitsPerSample", 0);
        few_bits_max = m->is_integer && bits > 0 && bits < int(type.size() * 8) && type.size() <= 4
                           ? std::exp2(bits) - 1
                           : 0;
        bits_scale = few_bits_max > 0 ? m->white / few_bits_max : 1;
        if (few_bits_max > 0)
            m->white = few_bits_max;
        if (c.name == "luminance") {
            scale = m->white > 0 ? m->white : 1;
            m->is_integer = false;
            m->white = 0;
        }
        return image_begin(m);
    }

    status read()
    {
        std::vector<int> wanted = c.value;
        if (c.alpha >= 0)
            wanted.push_back(c.alpha);
        band now(in, part);
        std::unique_ptr<OIIO::ImageInput> mask = open_mask();
        std::unique_ptr<band> mask_band;
        if (mask)
            mask_band.reset(new band(*mask, m->hints.mask));
        const int step = spec.tile_width ? std::max(spec.tile_height, 1) : int(ROWS);
        for (int y = 0; y < spec.height; y += step) {
            const int end = std::min(y + step, spec.height);
            if (!now.read(spec.y + y, spec.y + end, wanted))
                return damaged(in);
            /* The mask has strips or tiles of its own, of which only whole rows can be read. */
            if (mask && !mask_band->read(mask->spec().y + y, mask->spec().y + end, {0}))
                return damaged(*mask);
            for (int row = y; row < end; row++)
                send(now, mask_band.get(), size_t(row - y), row);
        }
        if (differ > 0)
            image_note(
                m, true,
                "its red, green and blue differ (in %llu pixels) and red is used (choose with 'channel': luminance, R, G or B)",
                (unsigned long long)differ);
        return OK;
    }

  private:
    /* Only colours are multiplied by alpha; depths, positions and the like are not. */
    bool is_data() const
    {
        for (const char *name : {"R", "G", "B", "Y", "luminance"})
            if (same(c.name, name))
                return false;
        return true;
    }

    std::unique_ptr<OIIO::ImageInput> open_mask() const
    {
        std::unique_ptr<OIIO::ImageInput> mask;
        if (m->hints.mask < 0)
            return mask;
        mask = OIIO::ImageInput::create("tiff");
        OIIO::ImageSpec first;
        if (!mask || !mask->open(m->open_path, first) || !mask->seek_subimage(m->hints.mask, 0) ||
            mask->spec().width != spec.width || mask->spec().height != spec.height ||
            mask->spec().tile_height != spec.tile_height)
            mask.reset();
        return mask;
    }

    status damaged(OIIO::ImageInput &input) const
    {
        const std::string why = input.geterror();
        return fail(E_INPUT, "%s: damaged image: %s", m->path,
                    why.empty() ? "its pixel data is truncated" : why.c_str());
    }

    void send(const band &now, const band *mask, size_t row, int y)
    {
        for (size_t i = 0; i < c.value.size(); i++)
            now.row(row, i, c.value[i], line[i]);
        if (c.compare)
            for (size_t x = 0; x < line[0].size(); x++)
                differ += line[0][x] != line[1][x] || line[0][x] != line[2][x];
        if (scale > 0)
            for (size_t x = 0; x < line[0].size(); x++)
                line[0][x] = 0.2126 * light(line[0][x] / scale, space, gamma) +
                             0.7152 * light(line[1][x] / scale, space, gamma) +
                             0.0722 * light(line[2][x] / scale, space, gamma);
        else if (few_bits_max > 0)
            for (double &v : line[0])
                v = std::round(v / bits_scale);
        const double opaque = c.alpha >= 0 ? white_of(type_of(spec, c.alpha)) : 0;
        if (c.alpha >= 0)
            now.row(row, c.value.size(), c.alpha, alpha);
        if (opaque > 0)
            for (double &a : alpha)
                a /= opaque;
        if (mask)
            mask->row(row, 0, 0, covered);
        image_row(m, 0, y, size_t(spec.width), line[0].data(), c.alpha >= 0 ? alpha.data() : nullptr,
                  mask ? covered.data() : nullptr);
    }

    OIIO::ImageInput &in;
    struct image_decoding *m;
    const OIIO::ImageSpec spec;
    const int part;
    const struct channels c;
    const std::string space;
    const double gamma;
    double few_bits_max = 0,
           bits_scale = 1; /* the largest value of so few bits; how far OpenImageIO spread them */
    double scale = 0;      /* luminance: the stored value of white; 0: not luminance */
    unsigned long long differ = 0;
    std::vector<double> line[3], alpha, covered;
};

std::unique_ptr<OIIO::ImageInput> open(const struct image_decoding *m, std::string *why)
{
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1); /* do not multiply channels by alpha */
    std::unique_ptr<OIIO::ImageInput> in;
    if (image_argument_is(m, ASK_FORM, "tiff")) {
        in = OIIO::ImageInput::create("tiff");
        if (in && !in->open(m->open_path, spec, config)) {
            *why = in->geterror();
            in.reset();
        }
    } else {
        in = OIIO::ImageInput::open(m->open_path, &config);
        if (!in)
            *why = OIIO::geterror();
    }
    return in;
}

status decode(struct image_decoding *m)
{
    status st = OK;
    std::string why;
    struct channels chosen;
    int part;
    OIIO::attribute("threads", 1);
    std::unique_ptr<OIIO::ImageInput> in = open(m, &why);
    if (!in)
        return fail(E_INPUT, "%s: not a readable image: %s", m->path, why.c_str());
    if ((st = pick_part(*in, m, &part)) != OK)
        return st;
    const OIIO::ImageSpec &spec = in->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
        return fail(
            E_INPUT,
            "%s: not a flat image (%d x %d x %d pixels, %d channels): deep and volume images are not supported",
            m->path, spec.width, spec.height, spec.depth, spec.nchannels);
    if (uint64_t(spec.width) > m->max_pixels / uint64_t(spec.height))
        return fail(E_INPUT, "%s: %d x %d pixels, more than the %llu million allowed here", m->path,
                    spec.width, spec.height, (unsigned long long)m->max_pixels / 1000000);
    if ((st = pick_channels(spec, m, &chosen)) != OK)
        return st;
    m->hints = image_hints_read(m->open_path, part, chosen.value[0]);
    mention_parts(*in, m);
    if (!in->seek_subimage(part, 0))
        return fail(E_INPUT, "%s: damaged image: %s", m->path, in->geterror().c_str());
    picture p(*in, m, part, chosen);
    if ((st = p.begin()) == OK)
        st = p.read();
    return st;
}

} // namespace

extern "C" status image_decode(struct image_decoding *m)
{
    try {
        return decode(m);
    } catch (const std::bad_alloc &) {
        return fail(E_INPUT,
                    "%s: decoding needs more memory than hoodoo-read-image may use: make the image smaller",
                    m->path);
    } catch (const std::exception &e) {
        return fail(E_INPUT, "%s: %s", m->path, e.what());
    } catch (...) {
        return fail(E_INPUT, "%s: unknown C++ exception while decoding", m->path);
    }
}
