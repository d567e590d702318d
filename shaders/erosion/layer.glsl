// A stratum's rates, as struct erosion (src/erosion/erosion.h) has them: layers[2 l] = (weak, strong, I in Pa, 0), and what of
// weather is its own, layers[2 l + 1] = (k_d, k_a, k_t, tau_c), negative where it is the job's. Needs READ_V(layers).

vec4 layer_rates(uint layer)
{
    return LOAD_V(layers, 2u * layer);
}

vec4 layer_weather(uint layer)
{
    return LOAD_V(layers, 2u * layer + 1u);
}
