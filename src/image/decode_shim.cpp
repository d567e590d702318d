#include "image/decode.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "image/band.hpp"
#include "image/choice.hpp"

namespace
{

enum { ROWS = 64 };

/* Light from what a colour space stores of it. */
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
    picture(OIIO::ImageInput &input, struct image_made *made, int input_part, const struct channels &chosen)
        : in(input), m(made), spec(input.spec()), part(input_part), c(chosen),
          space(spec.get_string_attribute("oiio:ColorSpace")),
          gamma(double(spec.get_float_attribute("oiio:Gamma", 1)))
    {
    }

    /* What stands in the picture, of pixels that are stored from somewhere in or around it. */
    status begin()
    {
        const bool has_window = std::string(in.format_name()) == "openexr";
        m->width = uint64_t(has_window ? spec.full_width : spec.width);
        m->height = uint64_t(has_window ? spec.full_height : spec.height);
        m->left = has_window ? int64_t(spec.x) - spec.full_x : 0;
        m->top = has_window ? int64_t(spec.y) - spec.full_y : 0;
        m->orientation = spec.get_int_attribute("Orientation", m->hints.orientation);
        m->premultiplied =
            c.alpha >= 0 && !spec.get_int_attribute("oiio:UnassociatedAlpha", 0) && !has_own_meaning();
        const OIIO::TypeDesc type = type_of(spec, c.value[0]);
        m->white = white_of(type);
        m->whole = m->white > 0;
        /* Numbers of few bits are spread over the whole type. */
        const int bits = spec.get_int_attribute("oiio:BitsPerSample", 0);
        few =
            m->whole && bits > 0 && bits < int(type.size() * 8) && type.size() <= 4 ? std::exp2(bits) - 1 : 0;
        spread = few > 0 ? m->white / few : 1;
        if (few > 0)
            m->white = few;
        if (c.name == "luminance") {
            scale = m->white > 0 ? m->white : 1;
            m->whole = false;
            m->white = 0;
        }
        const status st = image_begin(m);
        return st;
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
            /* The mask may lie in strips or tiles of its own: whole rows of those are always there to be read. */
            if (mask && !mask_band->read(mask->spec().y + y, mask->spec().y + end, {0}))
                return damaged(*mask);
            for (int row = y; row < end; row++)
                send(now, mask_band.get(), size_t(row - y), row);
        }
        if (differ > 0)
            image_note(m, true,
                       "its red, green and blue differ (in %llu pixels), and red is used: say channel: "
                       "luminance, or R, G or B",
                       (unsigned long long)differ);
        return OK;
    }

  private:
    /* Depth, positions and the like are not multiplied by alpha: that is done to colours. */
    bool has_own_meaning() const
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
        if (!mask || !mask->open(m->open, first) || !mask->seek_subimage(m->hints.mask, 0) ||
            mask->spec().width != spec.width || mask->spec().height != spec.height ||
            mask->spec().tile_height != spec.tile_height)
            mask.reset();
        return mask;
    }

    status damaged(OIIO::ImageInput &input) const
    {
        const std::string why = input.geterror();
        return fail(E_INPUT, "%s: damaged image: %s", m->path,
                    why.empty() ? "its pixels end early" : why.c_str());
    }

    void send(const band &now, const band *mask, size_t row, int y)
    {
        for (size_t i = 0; i < c.value.size(); i++)
            now.take(row, i, c.value[i], line[i]);
        if (c.compare)
            for (size_t x = 0; x < line[0].size(); x++)
                differ += line[0][x] != line[1][x] || line[0][x] != line[2][x];
        if (scale > 0)
            for (size_t x = 0; x < line[0].size(); x++)
                line[0][x] = 0.2126 * light(line[0][x] / scale, space, gamma) +
                             0.7152 * light(line[1][x] / scale, space, gamma) +
                             0.0722 * light(line[2][x] / scale, space, gamma);
        else if (few > 0)
            for (double &v : line[0])
                v = std::round(v / spread);
        const double opaque = c.alpha >= 0 ? white_of(type_of(spec, c.alpha)) : 0;
        if (c.alpha >= 0)
            now.take(row, c.value.size(), c.alpha, alpha);
        if (opaque > 0)
            for (double &a : alpha)
                a /= opaque;
        if (mask)
            mask->take(row, 0, 0, covered);
        image_row(m, 0, y, size_t(spec.width), line[0].data(), c.alpha >= 0 ? alpha.data() : nullptr,
                  mask ? covered.data() : nullptr);
    }

    OIIO::ImageInput &in;
    struct image_made *m;
    const OIIO::ImageSpec spec;
    const int part;
    const struct channels c;
    const std::string space;
    const double gamma;
    double few = 0, spread = 1, scale = 0;
    unsigned long long differ = 0;
    std::vector<double> line[3], alpha, covered;
};

std::unique_ptr<OIIO::ImageInput> open(const struct image_made *m, std::string *why)
{
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1); /* the channels as stored, not multiplied by alpha */
    std::unique_ptr<OIIO::ImageInput> in;
    if (image_asks(m, ASK_FORM, "tiff")) {
        in = OIIO::ImageInput::create("tiff");
        if (in && !in->open(m->open, spec, config)) {
            *why = in->geterror();
            in.reset();
        }
    } else {
        in = OIIO::ImageInput::open(m->open, &config);
        if (!in)
            *why = OIIO::geterror();
    }
    return in;
}

status decode(struct image_made *m)
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
        return fail(E_INPUT, "%s: not a flat image: %d x %d x %d pixels, %d channels", m->path, spec.width,
                    spec.height, spec.depth, spec.nchannels);
    if (uint64_t(spec.width) > m->max_pixels / uint64_t(spec.height))
        return fail(E_INPUT, "%s: %d x %d pixels, more than the %llu million allowed here", m->path,
                    spec.width, spec.height, (unsigned long long)m->max_pixels / 1000000);
    if ((st = pick_channels(spec, m, &chosen)) != OK)
        return st;
    m->hints = image_hints_read(m->open, part, chosen.value[0]);
    mention_parts(*in, m);
    if (!in->seek_subimage(part, 0))
        return fail(E_INPUT, "%s: damaged image: %s", m->path, in->geterror().c_str());
    picture p(*in, m, part, chosen);
    if ((st = p.begin()) == OK)
        st = p.read();
    return st;
}

} // namespace

extern "C" status image_decode(struct image_made *m)
{
    try {
        return decode(m);
    } catch (const std::bad_alloc &) {
        return fail(E_INPUT, "%s: decoding needs more memory than images may use", m->path);
    } catch (const std::exception &e) {
        return fail(E_INPUT, "%s: %s", m->path, e.what());
    } catch (...) {
        return fail(E_INPUT, "%s: unknown C++ exception while decoding", m->path);
    }
}
