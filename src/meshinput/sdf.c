#include "meshinput/sdf.h"

#include <stdatomic.h>

#include "meshinput/sdf_make.h"
#include "system/library.h"

/* Functions of hoodoo-vdb.so, set before the first distance field exists. */
static _Atomic(sdf_at_function *) at;
static _Atomic(sdf_destroy_function *) destroy;
static _Atomic(sdf_gap_function *) gap;

static status find_functions(void)
{
    status st = OK;
    sdf_at_function *found_at = NULL;
    sdf_destroy_function *found_destroy = NULL;
    sdf_gap_function *found_gap = NULL;
    TRY(library_find("sdf_at", &found_at));
    TRY(library_find("sdf_destroy", &found_destroy));
    TRY(library_find("sdf_gap", &found_gap));
    atomic_store(&at, found_at);
    atomic_store(&destroy, found_destroy);
    atomic_store(&gap, found_gap);
done:
    return st;
}

status vdb_sdf_create(const struct sdf_request *question, struct vdb_sdf **out)
{
    status st = OK;
    sdf_make_function *make = NULL;
    TRY(find_functions());
    TRY(library_find("sdf_make", &make));
    TRY(library_status(make(question, out)));
done:
    return st;
}

status vdb_sdf_from_samples(const struct sdf_samples *samples, struct vdb_sdf **out)
{
    status st = OK;
    sdf_from_samples_function *make = NULL;
    TRY(find_functions());
    TRY(library_find("sdf_from_samples", &make));
    TRY(library_status(make(samples, out)));
done:
    return st;
}

void vdb_sdf_destroy(struct vdb_sdf **sdf)
{
    sdf_destroy_function *call = atomic_load(&destroy);
    if (*sdf && call)
        call(sdf);
}

double vdb_sdf_at(const struct vdb_sdf *sdf, const double x[3])
{
    return atomic_load_explicit(&at, memory_order_relaxed)(sdf, x);
}

struct sdf_gap vdb_sdf_gap(const struct vdb_sdf *sdf)
{
    return atomic_load(&gap)(sdf);
}

status vdb_sdf_caps(const struct vdb_sdf *sdf, struct sdf_caps *out)
{
    status st = OK;
    sdf_caps_function *caps = NULL;
    *out = (struct sdf_caps){0};
    TRY(library_find("sdf_caps", &caps));
    TRY(library_status(caps(sdf, out)));
done:
    return st;
}
