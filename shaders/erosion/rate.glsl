// Retreat of bare rock of a layer at unit intensity, m/kyr (Arenite eq. 2): weak below the threshold I of
// compression, strong above it. With `band` > 0 the jump is smoothed over T = I (1 +- band / 2), linearly in
// log(rate). layer = (weak, strong, I in Pa, 0).

float retreat(vec4 layer, float rate_factor, float interlock_factor, float stress, float band)
{
    float threshold = layer.z * interlock_factor;
    float held = band > 0.0 ? clamp((stress - threshold) / (band * threshold) + 0.5, 0.0, 1.0)
                            : (stress > threshold ? 1.0 : 0.0);
    // the jump is smoothed in the logarithm; a rate of 0 has none
    float rate = held <= 0.0 ? layer.x : held >= 1.0 ? layer.y : layer.y > 0.0 && layer.x > 0.0
               ? layer.x * pow(layer.y / layer.x, held) : mix(layer.x, layer.y, held);
    return rate_factor * rate;
}
