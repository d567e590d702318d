// Deflation (Arenite eq. 12) of a grain under the pressure t. Needs PARAMS(wind_params).

float deflation(float t)
{
    float pull = max(0.0, k.cohesion + k.friction * t);
    return k.deflation * exp(-(pull * pull - k.cohesion * k.cohesion) / (2.0 * k.strength * k.strength));
}
