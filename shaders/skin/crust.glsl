// Factor of crust and damp in the rate of bare rock (formula: src/skin/README.md). The crust grows with age,
// but not where it is damp; weathering is fastest half-way between dry and wet.
float crust_rate(float age, float damp)
{
    float grown = (1.0 - exp(-age / k.crust_kyr)) * (1.0 - damp);
    return (1.0 + (k.damp - 1.0) * 4.0 * damp * (1.0 - damp)) / (1.0 + (k.crust - 1.0) * grown);
}
