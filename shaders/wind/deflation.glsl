// Deflation (Arenite eq. 12) of a grain under the pressure t, and the k_a of abrasion, times the wind's. `own` is what of weather is its
// layer's own. Needs PARAMS(wind_params) and erosion/layer.glsl.

float deflation(float t, vec4 own)
{
    float pull = max(0.0, k.cohesion + k.friction * t);
    float most = own.x < 0.0 ? k.deflation : own.x;
    return most * exp(-(pull * pull - k.cohesion * k.cohesion) / (2.0 * k.strength * k.strength));
}

float abrasion(vec4 own)
{
    return own.y < 0.0 ? k.abrasion : own.y * k.gale;
}
