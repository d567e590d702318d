// Grid to particles: velocity and its gradient where a particle is, in units of dx: 4 sum w v (x_i - x_p) per
// axis. One axis after the other. Needs READ_V(node_velocity), mpm/grid.glsl.

void collect(vec3 f, uint home, out vec3 v, out vec3 gx, out vec3 gy, out vec3 gz)
{
    uint row = k.cx + 3u, slab = row * (k.cy + 3u);
    vec3 w[3];
    mpm_weights(f, w[0], w[1], w[2]);
    v = gx = gy = gz = vec3(0.0);
    for (int z = 0; z < 3; z++) {
        vec3 v2 = vec3(0.0), gx2 = vec3(0.0), gy2 = vec3(0.0);
        for (int y = 0; y < 3; y++) {
            uint node = home + uint(z) * slab + uint(y) * row;
            vec3 a = w[0].x * LOAD_V(node_velocity, node).xyz, b = w[1].x * LOAD_V(node_velocity, node + 1u).xyz,
                 c = w[2].x * LOAD_V(node_velocity, node + 2u).xyz;
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
