// Damp of the air at a face, 0 to 1, by the share of rock in a ball around it: half on a plane, less on ribs
// and edges, more in hollows, which dry slowly. Needs fill_at() and k.radius.

const int DAMP_PAIRS = 48;              // points of the ball, and those opposite: on a plane one of each is rock
const float DRY = 0.5, WET = 0.8; // shares of rock

// Points spread evenly through half of the unit ball: directions on a spiral, radii by a low-discrepancy sequence.
vec3 damp_point(int i)
{
    float t = (float(i) + 0.5) / float(DAMP_PAIRS), up = t, turn = 2.39996323 * float(i);
    float r = pow(fract(0.5 + 0.7548776662 * float(i)), 1.0 / 3.0), level = sqrt(1.0 - up * up);
    return r * vec3(level * cos(turn), level * sin(turn), up);
}

// Below z = 0 is the mirror image, as beyond a wall.
float damp_fill(vec3 x)
{
    ivec3 v = ivec3(floor(x / k.h));
    v.z = v.z < 0 ? -1 - v.z : v.z;
    return fill_at(v);
}

float damp_at(vec3 x)
{
    if (k.radius <= 0.0)
        return 0.0;
    float rock = 0.0;
    for (int i = 0; i < DAMP_PAIRS; i++) {
        vec3 d = k.radius * damp_point(i);
        rock += damp_fill(x + d) + damp_fill(x - d);
    }
    return clamp((rock / float(2 * DAMP_PAIRS) - DRY) / (WET - DRY), 0.0, 1.0);
}
