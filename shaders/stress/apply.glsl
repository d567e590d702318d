// K u at a node: linear elasticity on trilinear hexahedra with full integration. One element matrix serves all cells,
// scaled by each cell's stiffness share.
//
// With N_a the product of (1 -+ x) / 2 along the axes, the blocks of the element matrix (over dx) are
//   K_ab^ii = (lambda + 2 mu) s_i m_j m_k + mu (s_j m_i m_k + s_k m_i m_j)
//   K_ab^ij = (lambda g_ai g_bj + mu g_aj g_bi) m_k / 4
// where along each axis s = 1, m = 1/3 if a and b agree, s = -1, m = 1/6 if not, and g = -1 at the low end, 1
// at the high end. Unrolled, only these coefficients remain; the rest is constant.
// Needs READ_U(run), READ_V(u), READ_F(fill), k.lambda, k.mu, k.dx, k.walls and stress/rows.glsl.

#define SAME(a, b) ((a) == (b))
#define M(a, b) (SAME(a, b) ? 1.0 / 3.0 : 1.0 / 6.0)
#define S(a, b) (SAME(a, b) ? 1.0 : -1.0)
#define G(a) (2.0 * float(a) - 1.0)
#define DIAGONAL(ai, bi, aj, bj, ak, bk)                                                                       \
    (stiff * (S(ai, bi) * M(aj, bj) * M(ak, bk)) +                                                             \
     shear * (S(aj, bj) * M(ai, bi) * M(ak, bk) + S(ak, bk) * M(ai, bi) * M(aj, bj)))
// lambda g_ai g_bj + mu g_aj g_bi is +-(lambda + mu) or +-(lambda - mu)
#define MIXED(ai, bi, aj, bj, ak, bk)                                                                          \
    ((G(ai) * G(bj) * M(ak, bk)) * (G(ai) * G(bj) == G(aj) * G(bi) ? both : difference))
#define TERM(ax, ay, az, bx, by, bz)                                                                           \
    {                                                                                                          \
        const vec3 w = near[(bz - az + 1) * 9 + (by - ay + 1) * 3 + (bx - ax + 1)];                            \
        float xy = MIXED(ax, bx, ay, by, az, bz), xz = MIXED(ax, bx, az, bz, ay, by);                          \
        float yx = MIXED(ay, by, ax, bx, az, bz), yz = MIXED(ay, by, az, bz, ax, bx);                          \
        float zx = MIXED(az, bz, ax, bx, ay, by), zy = MIXED(az, bz, ay, by, ax, bx);                          \
        f.x += DIAGONAL(ax, bx, ay, by, az, bz) * w.x + xy * w.y + xz * w.z;                                   \
        f.y += DIAGONAL(ay, by, ax, bx, az, bz) * w.y + yx * w.x + yz * w.z;                                   \
        f.z += DIAGONAL(az, bz, ax, bx, ay, by) * w.z + zx * w.x + zy * w.y;                                   \
    }
// The cell in which the node is corner (ax, ay, az).
#define CELL(ax, ay, az)                                                                                       \
    {                                                                                                          \
        vec3 f = vec3(0.0);                                                                                    \
        TERM(ax, ay, az, 0, 0, 0) TERM(ax, ay, az, 1, 0, 0) TERM(ax, ay, az, 0, 1, 0) TERM(ax, ay, az, 1, 1, 0) \
        TERM(ax, ay, az, 0, 0, 1) TERM(ax, ay, az, 1, 0, 1) TERM(ax, ay, az, 0, 1, 1) TERM(ax, ay, az, 1, 1, 1) \
        float scale = stiffness(LOAD_F(fill, row[(1 - az) * 3 + 1 - ay] - ax));                                \
        sum += scale * f;                                                                                      \
        scales += scale;                                                                                       \
    }

// For the node in slot `at`. xyz: K u (N, for u in m); w: the sum of its cells' stiffness shares.
vec4 apply_stiffness(uint at)
{
    float stiff = (k.lambda + 2.0 * k.mu) * k.dx, shear = k.mu * k.dx;
    float both = (k.lambda + k.mu) * k.dx / 4.0, difference = (k.lambda - k.mu) * k.dx / 4.0;
    uint own = LOAD_U(run, at / STRESS_RUN), row[9];
    vec3 near[27];
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++) {
            row[z * 3 + y] = row_at(own, at, y - 1, z - 1);
            for (uint x = 0u; x < 3u; x++)
                near[z * 9 + y * 3 + int(x)] = LOAD_V(u, row[z * 3 + y] + x - 1u).xyz;
        }
    vec3 sum = vec3(0.0);
    float scales = 0.0;
    CELL(0, 0, 0) CELL(1, 0, 0) CELL(0, 1, 0) CELL(1, 1, 0) CELL(0, 0, 1) CELL(1, 0, 1) CELL(0, 1, 1) CELL(1, 1, 1)
    if (k.walls != 0u)
        sum = along_walls(sum, node_of(own, at, CELLS), ivec3(CELLS), k.walls);
    return vec4(sum, scales);
}
