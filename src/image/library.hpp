/* The library that decodes images: OpenImageIO, or, in a bundle, where its three hundred packages would not fit, formats/.
 * Included by decode_shim.cpp, choice.hpp and band.hpp only. */
#ifndef HOODOO_IMAGE_LIBRARY_HPP
#define HOODOO_IMAGE_LIBRARY_HPP

#ifdef HOODOO_OWN_FORMATS
#include "image/formats/input.hpp"
namespace OIIO = formats;
#else
#include <OpenImageIO/imageio.h>
#endif

#endif
