// Deflation at the compression t (Arenite eq. 12, normalised to k_d on unstressed rock) and the coefficient of
// abrasion k_a (|v| / v_ref)^2. `own` holds the layer's own values, negative where the job's hold. Needs
// PARAMS(wind_params) and erosion/layer.glsl.

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
