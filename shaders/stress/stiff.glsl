// A cell's rock stiffness as a share of that of rock without joints. Needs READ_F(stiff), which has no margin
// and is not read if k.jointed is 0.

float stiff_rock(ivec3 c)
{
    ivec3 cells = ivec3(k.cx, k.cy, k.cz) - 2, inner = clamp(c - 1, ivec3(0), cells - 1);
    return k.jointed == 0u ? 1.0 : LOAD_F(stiff, (inner.z * cells.y + inner.y) * cells.x + inner.x);
}
