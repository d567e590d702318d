// Access to a layer's rates, laid out as in struct erosion (src/erosion/erosion.h): layers[2 l] = (weak, strong
// in m/kyr, I in Pa, 0) and layers[2 l + 1] = the layer's own (k_d, k_a, k_t, tau_c), negative where the job's
// value holds. Needs READ_V(layers).

vec4 layer_rates(uint layer)
{
    return LOAD_V(layers, 2u * layer);
}

vec4 layer_weather(uint layer)
{
    return LOAD_V(layers, 2u * layer + 1u);
}
