#include "image/hints.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

#include "image/image.h"

/* ---- TIFF: the tags of GeoTIFF and GDAL, which must be registered with libtiff */

enum {
    PIXEL_SCALE = 33550,
    TIE_POINTS = 33922,
    TRANSFORMATION = 34264,
    GEO_KEYS = 34735,
    GDAL_ITEMS = 42112,
    GDAL_NO_DATA = 42113
};

/* Keys of GEO_KEYS and their values. */
enum {
    KEY_MODEL = 1024,
    KEY_RASTER = 1025,
    KEY_UNIT = 3076,
    KEY_UNIT_UP = 4099,
    KIND_PROJECTED = 1,
    KIND_GEOGRAPHIC = 2,
    RASTER_POINTS = 2,
    UNIT_FOOT = 9002,
    UNIT_SURVEY_FOOT = 9003
};

static void add_tags(TIFF *tiff)
{
    static char names[6][16] = {"PixelScale", "TiePoints",    "Transformation",
                                "GeoKeys",    "GDALMetadata", "GDALNoData"};
    static const TIFFFieldInfo tags[] = {
        {PIXEL_SCALE, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, names[0]},
        {TIE_POINTS, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, names[1]},
        {TRANSFORMATION, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, names[2]},
        {GEO_KEYS, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_SHORT, FIELD_CUSTOM, 1, 1, names[3]},
        {GDAL_ITEMS, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_ASCII, FIELD_CUSTOM, 1, 0, names[4]},
        {GDAL_NO_DATA, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_ASCII, FIELD_CUSTOM, 1, 0, names[5]},
    };
    TIFFMergeFieldInfo(tiff, tags, sizeof tags / sizeof *tags);
}

static size_t numbers(TIFF *tiff, uint32_t tag, const void **out)
{
    uint16_t n = 0;
    *out = NULL;
    return TIFFGetField(tiff, tag, &n, out) == 1 && *out ? n : 0;
}

static unsigned geo_key(TIFF *tiff, unsigned key)
{
    const void *data;
    const size_t n = numbers(tiff, GEO_KEYS, &data);
    const uint16_t *k = data;
    for (size_t i = 4; i + 3 < n; i += 4)
        if (k[i] == key && k[i + 1] == 0)
            return k[i + 3];
    return 0;
}

static double unit_of(unsigned code)
{
    return code == UNIT_FOOT ? 0.3048 : code == UNIT_SURVEY_FOOT ? 1200.0 / 3937 : 1;
}

/* Pixel size and first corner, in the map's unit. */
static enum image_map find_place(TIFF *tiff, struct image_hints *h)
{
    const void *scale, *tie, *matrix;
    const size_t n_scale = numbers(tiff, PIXEL_SCALE, &scale), n_tie = numbers(tiff, TIE_POINTS, &tie);
    if (n_scale >= 2 && n_tie >= 6) {
        const double *s = scale, *t = tie;
        h->pixel[0] = s[0];
        h->pixel[1] = s[1];
        h->corner[0] = t[3] - t[0] * s[0];
        h->corner[1] = t[4] + t[1] * s[1];
    } else if (numbers(tiff, TRANSFORMATION, &matrix) >= 16) {
        const double *a = matrix;
        if (fabs(a[1]) > 1e-9 * fabs(a[0]) || fabs(a[4]) > 1e-9 * fabs(a[5]))
            return IMAGE_MAP_TURNED;
        h->pixel[0] = a[0];
        h->pixel[1] = -a[5];
        h->corner[0] = a[3];
        h->corner[1] = a[7];
    } else {
        return IMAGE_NO_MAP;
    }
    for (int i = 0; i < 2; i++)
        if (!isfinite(h->corner[i]) || !(fabs(h->pixel[i]) > 0 && fabs(h->pixel[i]) < 1e9))
            return IMAGE_NO_MAP;
    if (geo_key(tiff, KEY_RASTER) == RASTER_POINTS) {
        h->corner[0] -= h->pixel[0] / 2;
        h->corner[1] += h->pixel[1] / 2;
    }
    return IMAGE_MAP_METRES;
}

/* Without a coordinate system, small pixels at coordinates that could be longitude and latitude are taken for degrees. */
static bool looks_like_degrees(const struct image_hints *h)
{
    return fabs(h->pixel[0]) < 0.05 && fabs(h->corner[0]) <= 360 && fabs(h->corner[1]) <= 90;
}

static void find_map(TIFF *tiff, struct image_hints *h)
{
    const unsigned kind = geo_key(tiff, KEY_MODEL);
    const double unit = unit_of(geo_key(tiff, KEY_UNIT)), up = unit_of(geo_key(tiff, KEY_UNIT_UP));
    h->map = (int)find_place(tiff, h);
    h->has_system = kind == KIND_PROJECTED;
    if (geo_key(tiff, KEY_UNIT_UP))
        h->height_unit = up;
    if (h->map != IMAGE_MAP_METRES)
        return;
    if (kind == KIND_GEOGRAPHIC || (kind != KIND_PROJECTED && looks_like_degrees(h)))
        h->map = IMAGE_MAP_DEGREES;
    for (int i = 0; h->map == IMAGE_MAP_METRES && i < 2; i++) {
        h->pixel[i] *= unit;
        h->corner[i] *= unit;
    }
}

/* The number in <Item name="SCALE" sample="0" role="scale">0.1</Item>, if there is such an item for that sample. */
static bool find_item(const char *items, const char *name, int sample, struct image_hints *h, double *out)
{
    char wanted[32];
    snprintf(wanted, sizeof wanted, "sample=\"%d\"", sample);
    for (const char *at = items; (at = strstr(at, "<Item")); at++) {
        const char *end = strchr(at, '>'), *is = strstr(at, name), *of = strstr(at, wanted);
        char *rest;
        if (!end || !is || is > end || !of || of > end)
            continue;
        *out = strtod(end + 1, &rest);
        h->damaged_scale |= rest == end + 1 || *rest != '<' || !isfinite(*out);
        return true;
    }
    return false;
}

static void find_meaning(TIFF *tiff, int channel, struct image_hints *h)
{
    char *text = NULL, *end;
    if (TIFFGetField(tiff, GDAL_NO_DATA, &text) == 1 && text) {
        h->nodata = strtod(text, &end);
        h->has_nodata = end != text;
    }
    text = NULL;
    if (TIFFGetField(tiff, GDAL_ITEMS, &text) == 1 && text) {
        h->has_scale = find_item(text, "role=\"scale\"", channel, h, &h->scale);
        h->has_scale |= find_item(text, "role=\"offset\"", channel, h, &h->offset);
        h->damaged_scale |= h->has_scale && h->scale == 0;
    }
}

/* A part's mask is the next part, of the same size; smaller copies of a part follow it, too. */
static void find_mask(TIFF *tiff, int part, struct image_hints *h)
{
    uint32_t width = 0, height = 0, w = 0, high = 0, kind = 0;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
    if (!TIFFReadDirectory(tiff))
        return;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SUBFILETYPE, &kind);
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &w);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &high);
    if ((kind & FILETYPE_MASK) && w == width && high == height)
        h->mask = part + 1;
    h->next_is_related = (kind & (FILETYPE_MASK | FILETYPE_REDUCEDIMAGE)) != 0;
}

static void read_tiff(const char *path, int part, int channel, struct image_hints *h)
{
    TIFFSetErrorHandler(NULL);
    TIFFSetWarningHandler(NULL);
    TIFFSetTagExtender(add_tags);
    TIFF *tiff = TIFFOpen(path, "r");
    if (!tiff)
        return;
    if (part == 0 || TIFFSetDirectory(tiff, (tdir_t)part)) {
        find_map(tiff, h);
        find_meaning(tiff, channel, h);
        find_mask(tiff, part, h);
    }
    TIFFClose(tiff);
}

/* ---- PNG: its eXIf chunk holds a small TIFF */

static uint32_t number_of(const unsigned char *p, size_t n, bool big_endian)
{
    uint32_t v = 0;
    for (size_t i = 0; i < n; i++)
        v |= (uint32_t)p[i] << 8 * (big_endian ? n - 1 - i : i);
    return v;
}

int image_exif_orientation(const unsigned char *exif, size_t n)
{
    if (n < 8)
        return 0;
    const bool big = exif[0] == 'M';
    const size_t at = number_of(exif + 4, 4, big);
    if (at > n || n - at < 2)
        return 0;
    const size_t entries = number_of(exif + at, 2, big);
    for (size_t i = 0; i < entries && at + 2 + 12 * (i + 1) <= n; i++) {
        const unsigned char *entry = exif + at + 2 + 12 * i;
        if (number_of(entry, 2, big) == 274)
            return (int)number_of(entry + 8, 2, big);
    }
    return 0;
}

static void read_png(FILE *f, struct image_hints *h)
{
    unsigned char head[8], exif[4096];
    while (fread(head, 1, 8, f) == 8) {
        const uint32_t size = number_of(head, 4, true);
        if (memcmp(head + 4, "eXIf", 4) == 0 && size <= sizeof exif && fread(exif, 1, size, f) == size) {
            h->orientation = image_exif_orientation(exif, size);
            return;
        }
        if (fseek(f, (long)size + 4, SEEK_CUR) != 0)
            return;
    }
}

struct image_hints image_hints_read(const char *path, int part, int channel)
{
    static const unsigned char png[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    struct image_hints h = {.mask = -1, .scale = 1};
    unsigned char magic[8] = {0};
    FILE *f = fopen(path, "rb");
    if (!f)
        return h;
    const size_t n = fread(magic, 1, sizeof magic, f);
    if (n == 8 && memcmp(magic, png, 8) == 0)
        read_png(f, &h);
    else if (n == 8 && (memcmp(magic, "II", 2) == 0 || memcmp(magic, "MM", 2) == 0))
        read_tiff(path, part, channel, &h);
    fclose(f);
    return h;
}
