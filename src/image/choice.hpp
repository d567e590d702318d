/* Chooses the part (subimage) of a file and its channels. Included by decode_shim.cpp only. */
#ifndef HOODOO_IMAGE_CHOICE_HPP
#define HOODOO_IMAGE_CHOICE_HPP

#include <cstdlib>
#include <string>
#include <strings.h>
#include <vector>

#include "image/library.hpp"

#include "image/rows.h"

namespace
{

enum { MOST_PARTS = 4096 };

/* Channels by number: the one to read, or red, green and blue for luminance; and alpha. */
struct channels {
    std::vector<int> value;
    int alpha = -1;
    bool compare =
        false;        /* red was not chosen by the job: count the pixels whose red, green and blue differ */
    std::string name; /* of value[0], or "luminance" */
};

std::string list_of(const std::vector<std::string> &names)
{
    std::string all;
    for (size_t i = 0; i < names.size() && all.size() < 600; i++)
        all += (i ? ", " : "") + (names[i].empty() ? std::to_string(i) : names[i]);
    return all;
}

/* The number that `text` is, 0 or more; -1 if it is not a number. */
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

status pick_part(OIIO::ImageInput &in, struct image_decoding *m, int *part)
{
    const char *wish = m->argument[ASK_PART];
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
    return fail(E_USAGE, "%s: no part '%.80s'; the file has %zu: %s", m->path, wish, names.size(),
                list_of(names).c_str());
}

/* Notes that the first of several parts is used, if the job did not choose one. */
void mention_parts(OIIO::ImageInput &in, struct image_decoding *m)
{
    if (*m->argument[ASK_PART] || m->hints.next_is_related || !in.seek_subimage(1, 0)) {
        in.geterror();
    } else {
        const std::string other = part_name(in.spec());
        image_note(m, false,
                   "the file has several parts and the first is used; the next is %s (choose with 'part')",
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

status pick_channels(const OIIO::ImageSpec &spec, struct image_decoding *m, struct channels *out)
{
    const char *wish = m->argument[ASK_CHANNEL];
    const int rgb[] = {find_channel(spec, "R"), find_channel(spec, "G"), find_channel(spec, "B")};
    const bool colours = rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0;
    out->alpha = spec.alpha_channel;
    if (same("luminance", wish) && colours) {
        out->value.assign(rgb, rgb + 3);
        out->name = "luminance";
        return OK;
    }
    /* Beside X and Z, Y is a coordinate and not a luminance. */
    const bool position = find_channel(spec, "X") >= 0 && find_channel(spec, "Z") >= 0;
    int one = *wish ? find_channel(spec, wish) : position ? -1 : find_channel(spec, "Y");
    if (one < 0 && *wish && number_of(wish) < spec.nchannels)
        one = number_of(wish);
    if (one < 0 && *wish)
        return fail(E_USAGE, "%s: no channel '%.80s'; the file has %d: %s", m->path, wish, spec.nchannels,
                    list_of(spec.channelnames).c_str());
    const int first = spec.nchannels > 1 && out->alpha == 0 ? 1 : 0;
    out->value.assign(1, one >= 0 ? one : first);
    out->name = spec.channelnames[size_t(out->value[0])];
    if (out->value[0] == out->alpha)
        out->alpha = -1; /* alpha chosen by name is read as values */
    const int others = spec.nchannels - 1 - (out->alpha >= 0);
    if (!*wish && others > 0 && colours && out->value[0] == rgb[0]) {
        out->value.assign(rgb, rgb + 3);
        out->compare = true;
    } else if (!*wish && others > 0) {
        image_note(m, false, "the file has %d channels and %s is used (choose with 'channel': %s)",
                   spec.nchannels, out->name.c_str(), list_of(spec.channelnames).c_str());
    }
    return OK;
}

} // namespace

#endif
