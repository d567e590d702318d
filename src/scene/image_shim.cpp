#include "scene/image_shim.h"

#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include <OpenImageIO/imageio.h>

static status decode(const char *path, size_t max_pixels, size_t *width, size_t *height, float **value)
{
    OIIO::attribute("threads", 1);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1); /* the channel as stored, not multiplied by alpha */
    std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(path, &config);
    if (!in)
        return fail(E_INPUT, "%s: not a readable image: %s", path, OIIO::geterror().c_str());
    const OIIO::ImageSpec &spec = in->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
        return fail(E_INPUT, "%s: not a flat image: %d x %d x %d pixels, %d channels", path, spec.width,
                    spec.height, spec.depth, spec.nchannels);
    if (size_t(spec.width) > max_pixels / size_t(spec.height))
        return fail(E_INPUT, "%s: %d x %d pixels, more than the %zu million allowed here", path, spec.width,
                    spec.height, max_pixels / 1000000);
    const size_t n = size_t(spec.width) * size_t(spec.height);
    *value = static_cast<float *>(std::calloc(n, sizeof(float)));
    if (!*value)
        throw std::bad_alloc();
    if (!in->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, *value)) {
        const std::string why = in->geterror();
        return fail(E_INPUT, "%s: damaged image: %s", path,
                    why.empty() ? "its pixels end early" : why.c_str());
    }
    *width = size_t(spec.width);
    *height = size_t(spec.height);
    return OK;
}

extern "C" status image_decode(const char *path, size_t max_pixels, size_t *width, size_t *height,
                               float **value)
{
    status st;
    *value = nullptr;
    try {
        st = decode(path, max_pixels, width, height, value);
    } catch (const std::bad_alloc &) {
        st = fail(E_INPUT, "%s: decoding needs more memory than images may use", path);
    } catch (const std::exception &e) {
        st = fail(E_INPUT, "%s: %s", path, e.what());
    } catch (...) {
        st = fail(E_INPUT, "%s: unknown C++ exception while decoding", path);
    }
    if (st != OK) {
        std::free(*value);
        *value = nullptr;
    }
    return st;
}
