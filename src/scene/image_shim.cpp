#include "scene/image_shim.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <strings.h>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace
{

enum { ROWS = 64, MOST_PARTS = 4096 };

/* Its channels, by number: those whose light is added up, or the one that is read; and the alpha. */
struct channels {
    std::vector<int> value;
    int alpha = -1;
    bool compare = false; /* nobody chose the first: do red, green and blue differ? */
    std::string name;     /* of the first */
};

std::string list_of(const std::vector<std::string> &names)
{
    std::string all;
    for (size_t i = 0; i < names.size() && all.size() < 600; i++)
        all += (i ? ", " : "") + (names[i].empty() ? std::to_string(i) : names[i]);
    return all;
}

/* A number from 0, or -1. */
int number_of(const char *text)
{
    char *end;
    const long n = std::strtol(text, &end, 10);
    return *text && !*end && n >= 0 && n < 1000000 ? int(n) : -1;
}

bool same(const std::string &a, const char *b)
{
    return strcasecmp(a.c_str(), b) == 0;
}

std::string part_name(const OIIO::ImageSpec &spec)
{
    return spec.get_string_attribute("oiio:subimagename", spec.get_string_attribute("PageName"));
}

status pick_part(OIIO::ImageInput &in, struct image_made *m, int *part)
{
    const char *wish = m->word[ASK_PART];
    std::vector<std::string> names;
    *part = 0;
    if (!*wish)
        return OK;
    for (int i = 0; i < MOST_PARTS && in.seek_subimage(i, 0); i++) {
        names.push_back(part_name(in.spec()));
        if (names.back() == wish || (number_of(wish) == i && names.back().empty())) {
            *part = i;
            return OK;
        }
    }
    in.geterror();
    const int number = number_of(wish);
    if (number >= 0 && size_t(number) < names.size() && in.seek_subimage(number, 0)) {
        *part = number;
        return OK;
    }
    return fail(E_USAGE, "%s: no part '%.80s': there are %zu: %s", m->path, wish, names.size(),
                list_of(names).c_str());
}

/* Nobody chose the first of several. */
void mention_parts(OIIO::ImageInput &in, struct image_made *m)
{
    if (*m->word[ASK_PART] || m->hints.belongs || !in.seek_subimage(1, 0)) {
        in.geterror();
    } else {
        const std::string other = part_name(in.spec());
        image_note(m, false,
                   "it holds several pictures: the first is used (the next is %s; choose by 'part')",
                   other.empty() ? "1" : other.c_str());
    }
}

int find_channel(const OIIO::ImageSpec &spec, const char *name)
{
    for (int exact = 1; exact >= 0; exact--)
        for (int i = 0; i < spec.nchannels; i++)
            if (exact ? spec.channelnames[size_t(i)] == name : same(spec.channelnames[size_t(i)], name))
                return i;
    return -1;
}

status pick_channels(const OIIO::ImageSpec &spec, struct image_made *m, struct channels *out)
{
    const char *wish = m->word[ASK_CHANNEL];
    const int rgb[] = {find_channel(spec, "R"), find_channel(spec, "G"), find_channel(spec, "B")};
    const bool colours = rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0;
    out->alpha = spec.alpha_channel;
    if (same("luminance", wish) && colours) {
        out->value.assign(rgb, rgb + 3);
        out->name = "luminance";
        return OK;
    }
    /* Where there are X and Z, too, Y is no brightness. */
    const bool position = find_channel(spec, "X") >= 0 && find_channel(spec, "Z") >= 0;
    int one = *wish ? find_channel(spec, wish) : position ? -1 : find_channel(spec, "Y");
    if (one < 0 && *wish && number_of(wish) < spec.nchannels)
        one = number_of(wish);
    if (one < 0 && *wish)
        return fail(E_USAGE, "%s: no channel '%.80s': there are %d: %s", m->path, wish, spec.nchannels,
                    list_of(spec.channelnames).c_str());
    const int first = spec.nchannels > 1 && out->alpha == 0 ? 1 : 0;
    out->value.assign(1, one >= 0 ? one : first);
    out->name = spec.channelnames[size_t(out->value[0])];
    if (out->value[0] == out->alpha)
        out->alpha = -1; /* who asks for it by name wants its values */
    const int others = spec.nchannels - 1 - (out->alpha >= 0);
    if (!*wish && others > 0 && colours && out->value[0] == rgb[0]) {
        out->value.assign(rgb, rgb + 3);
        out->compare = true;
    } else if (!*wish && others > 0) {
        image_note(m, false, "it has %d channels: %s is used (choose by 'channel'; there are %s)",
                   spec.nchannels, out->name.c_str(), list_of(spec.channelnames).c_str());
    }
    return OK;
}

/* ---- rows */

double number_at(const void *bytes, OIIO::TypeDesc type, size_t i)
{
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
        return static_cast<const uint8_t *>(bytes)[i];
    case OIIO::TypeDesc::INT8:
        return static_cast<const int8_t *>(bytes)[i];
    case OIIO::TypeDesc::UINT16:
        return static_cast<const uint16_t *>(bytes)[i];
    case OIIO::TypeDesc::INT16:
        return static_cast<const int16_t *>(bytes)[i];
    case OIIO::TypeDesc::UINT32:
        return static_cast<const uint32_t *>(bytes)[i];
    case OIIO::TypeDesc::INT32:
        return static_cast<const int32_t *>(bytes)[i];
    case OIIO::TypeDesc::UINT64:
        return double(static_cast<const uint64_t *>(bytes)[i]);
    case OIIO::TypeDesc::INT64:
        return double(static_cast<const int64_t *>(bytes)[i]);
    case OIIO::TypeDesc::DOUBLE:
        return static_cast<const double *>(bytes)[i];
    default:
        return double(static_cast<const float *>(bytes)[i]);
    }
}

/* Halves are read as floats. */
OIIO::TypeDesc type_of(const OIIO::ImageSpec &spec, int channel)
{
    const OIIO::TypeDesc t = spec.channelformat(channel);
    return t.basetype == OIIO::TypeDesc::HALF || t.basetype == OIIO::TypeDesc::UNKNOWN ? OIIO::TypeDesc::FLOAT
                                                                                       : t;
}

double white_of(OIIO::TypeDesc type)
{
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
        return 255;
    case OIIO::TypeDesc::INT8:
        return 127;
    case OIIO::TypeDesc::UINT16:
        return 65535;
    case OIIO::TypeDesc::INT16:
        return 32767;
    case OIIO::TypeDesc::UINT32:
        return 4294967295.0;
    case OIIO::TypeDesc::INT32:
        return 2147483647.0;
    case OIIO::TypeDesc::UINT64:
        return 18446744073709551615.0;
    case OIIO::TypeDesc::INT64:
        return 9223372036854775807.0;
    default:
        return 0;
    }
}

/* The numbers of one channel of some rows: where they are is decoded once where all wanted channels are of one type and
 * near each other, else for each of them. */
class band
{
  public:
    band(OIIO::ImageInput &input, int input_part) : in(input), spec(input.spec()), part(input_part)
    {
    }

    bool read(int first_row, int end_row, const std::vector<int> &wanted)
    {
        const auto range = std::minmax_element(wanted.begin(), wanted.end());
        rows = size_t(end_row - first_row);
        const bool together = spec.channelformats.empty() && *range.second - *range.first < 4;
        store.resize(together ? 1 : wanted.size());
        low.clear();
        for (size_t i = 0; i < store.size(); i++) {
            const int from = together ? *range.first : wanted[i],
                      to = together ? *range.second + 1 : from + 1;
            low.push_back(from);
            count = size_t(to - from);
            const OIIO::TypeDesc type = type_of(spec, from);
            store[i].resize(rows * size_t(spec.width) * count * type.size());
            const bool good =
                spec.tile_width
                    ? in.read_tiles(part, 0, spec.x, spec.x + spec.width, first_row, end_row, spec.z,
                                    spec.z + 1, from, to, type, store[i].data())
                    : in.read_scanlines(part, 0, first_row, end_row, spec.z, from, to, type, store[i].data());
            if (!good)
                return false;
        }
        return true;
    }

    /* Row `y` of what was read, of the wanted channel `i`, whose number is `channel`. */
    void take(size_t y, size_t i, int channel, std::vector<double> &out) const
    {
        const size_t s = store.size() == 1 ? 0 : i, skip = size_t(channel - low[s]), n = size_t(spec.width);
        const OIIO::TypeDesc type = type_of(spec, channel);
        out.resize(n);
        for (size_t x = 0; x < n; x++)
            out[x] = number_at(store[s].data(), type, (y * n + x) * count + skip);
    }

  private:
    OIIO::ImageInput &in;
    const OIIO::ImageSpec spec;
    const int part;
    size_t rows = 0, count = 1;
    std::vector<std::vector<unsigned char>> store;
    std::vector<int> low;
};

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
