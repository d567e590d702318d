/* The share of random cases that a test tries: HOODOO_TEST_EFFORT, 1 if it is not set. Sanitizers are slow and run a quarter of the
 * cases; `make test-long` runs several times as many. */
#ifndef HOODOO_TESTS_EFFORT_H
#define HOODOO_TESTS_EFFORT_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

/* Whether this is built with the address or the thread sanitizer. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { SANITIZED = 1 };
#elif defined(__has_feature)
enum { SANITIZED = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) };
#else
enum { SANITIZED = 0 };
#endif

static inline double effort(void)
{
    const char *set = getenv("HOODOO_TEST_EFFORT");
    const double share = set ? strtod(set, NULL) : 1;
    return share > 0 ? share : 1;
}

/* How many to try of n cases that are drawn at random. */
static inline size_t effort_of(size_t n)
{
    return (size_t)ceil(effort() * (double)n);
}

/* Whether to try case i of a list. A quarter of the effort takes every fourth, from the third on. */
static inline bool effort_takes(size_t i)
{
    const double share = effort();
    return share >= 1 || floor(share * (double)(i + 2)) > floor(share * (double)(i + 1));
}

#endif
