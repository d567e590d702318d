// What crust and damp multiply the rate of bare rock with: the crust grows with its age, but for what is damp; and weathering is fastest
// half-way between dry and wet, where it dries and is wetted again.
float crust_rate(float age, float damp)
{
    float grown = (1.0 - exp(-age / k.crust_kyr)) * (1.0 - damp);
    return (1.0 + (k.damp - 1.0) * 4.0 * damp * (1.0 - damp)) / (1.0 + (k.crust - 1.0) * grown);
}
