/* The functions of hoodoo-vdb.so behind function.c: the expression evaluator (muparser). */
#ifndef HOODOO_SHAPE_FUNCTION_MAKE_H
#define HOODOO_SHAPE_FUNCTION_MAKE_H

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct formula;

/* noise(x, y, z) in expressions. */
typedef double formula_noise(const void *context, const double x[3]);

/* Parses an expression in x, y and z. E_USAGE: it is malformed; the message has the position. */
typedef status formula_make_function(const char *expression, formula_noise *noise, const void *context,
                                     struct formula **out);
typedef void formula_destroy_function(struct formula **formula);

/* Thread-safe; the same point gives the same bits. NaN where it cannot be evaluated. */
typedef double formula_at_function(const struct formula *formula, const double x[3]);

formula_make_function formula_make;
formula_destroy_function formula_destroy;
formula_at_function formula_at;

#ifdef __cplusplus
}
#endif
#endif
