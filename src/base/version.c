#include "base/version.h"

#include "base/build.h"

const char hoodoo_version[] = HOODOO_VERSION;
const char hoodoo_commit[] = HOODOO_COMMIT;
const char hoodoo_build[] = HOODOO_BUILD;
