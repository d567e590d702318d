// Grid to particles: v = sum w_i v_i and its gradient times dx, 4 sum w_i v_i (x_i - x_p)^T / dx, axis by axis
// (the affine matrix C of APIC times dx). Needs READ_U(reach), READ_V(velocity), mpm/grid.glsl.

vec3 met(uint part, uint a)
{
    return LOAD_V(velocity, LOAD_U(reach, a * k.n_parts + part)).xyz;
}

void collect(vec3 f, uint part, out vec3 v, out vec3 gx, out vec3 gy, out vec3 gz)
{
    vec3 w[3];
    mpm_weights(f, w[0], w[1], w[2]);
    v = gx = gy = gz = vec3(0.0);
    for (int z = 0; z < 3; z++) {
        vec3 v2 = vec3(0.0), gx2 = vec3(0.0), gy2 = vec3(0.0);
        for (int y = 0; y < 3; y++) {
            uint first = uint(z * 9 + y * 3);
            vec3 a = w[0].x * met(part, first), b = w[1].x * met(part, first + 1u), c = w[2].x * met(part, first + 2u);
            vec3 v1 = a + b + c;
            vec3 gx1 = b + 2.0 * c - f.x * v1;
            v2 += w[y].y * v1;
            gx2 += w[y].y * gx1;
            gy2 += w[y].y * (float(y) - f.y) * v1;
        }
        v += w[z].z * v2;
        gx += w[z].z * gx2;
        gy += w[z].z * gy2;
        gz += w[z].z * (float(z) - f.z) * v2;
    }
    gx *= 4.0;
    gy *= 4.0;
    gz *= 4.0;
}
