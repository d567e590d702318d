/* A band of rows of an image, as stored numbers. Included by decode_shim.cpp only. */
#ifndef HOODOO_IMAGE_BAND_HPP
#define HOODOO_IMAGE_BAND_HPP

#include <algorithm>
#include <vector>

#include "image/library.hpp"

namespace
{

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

/* OpenImageIO converts half floats to floats. */
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

/* The stored numbers of some channels, for a band of rows. The channels are decoded in one call if they have the same type and are
 * close to each other, otherwise in one call each. */
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

    /* Copies row y of the band, of the i-th wanted channel, whose number in the file is `channel`. */
    void row(size_t y, size_t i, int channel, std::vector<double> &out) const
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

} // namespace

#endif
