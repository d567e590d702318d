#include "render/develop.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

double develop_view(double x)
{
    static const double n = 1.3, grey = 0.18, white = 4;
    /* s^n for which grey is unchanged and white is 1. Two iterations converge to more than picture accuracy. */
    double s = pow(grey, n) * (1 / grey - 1), top = 1;
    for (int i = 0; i < 8; i++) {
        top = pow(white, n) / (pow(white, n) + s);
        s = pow(grey, n) * (1 / (grey * top) - 1);
    }
    double power = pow(fmax(x, 0), n);
    return fmin(power / (power + s) / top, 1);
}

static unsigned char srgb(double linear)
{
    double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
    return (unsigned char)lrint(255 * fmin(fmax(v, 0), 1));
}

void develop_color(const double linear[3], double exposure, unsigned char rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = srgb(develop_view(exposure * linear[c]));
}

/* The next number of a header, after blanks and comments; 0 if there is none. */
static size_t header_number(const unsigned char *bytes, size_t n, size_t *at)
{
    size_t value = 0;
    while (*at < n && (bytes[*at] == '#' || bytes[*at] == ' ' || bytes[*at] == '\n'))
        if (bytes[(*at)++] == '#')
            while (*at < n && bytes[*at] != '\n')
                (*at)++;
    for (; *at < n && bytes[*at] >= '0' && bytes[*at] <= '9' && value < 1000000; (*at)++)
        value = 10 * value + (size_t)(bytes[*at] - '0');
    return value;
}

status develop_ppm(void *bytes, size_t *n, double white, double exposure)
{
    unsigned char *at = bytes, table[4096];
    size_t read = 2, width = header_number(at, *n, &read), height = header_number(at, *n, &read);
    if (*n < 2 || at[0] != 'P' || at[1] != '6' || width < 1 || height < 1 ||
        header_number(at, *n, &read) != 65535)
        return fail(E_INPUT, "not a 16-bit PPM (P6)");
    const unsigned char *from = at + read + 1;
    size_t values = 3 * width * height;
    if (*n < read + 1 + 2 * values)
        return fail(E_INPUT, "the picture is truncated");
    /* The table is indexed by the square root, so that dark tones have as many steps as light ones. */
    for (int i = 0; i < 4096; i++)
        table[i] = srgb(develop_view(white * exposure * pow((i + 0.5) / 4096, 2)));
    size_t put = (size_t)sprintf((char *)at, "P6\n%zu %zu\n255\n", width, height);
    for (size_t i = 0; i < values; i++) {
        double v = (from[2 * i] * 256.0 + from[2 * i + 1]) / 65535;
        at[put + i] = table[(int)fmin(4096 * sqrt(v), 4095)];
    }
    *n = put + values;
    return OK;
}
