#include "base/version.h"

const char hoodoo_version[] = HOODOO_VERSION;
const char hoodoo_commit[] = HOODOO_COMMIT;
