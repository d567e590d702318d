// Average velocity from sums of velocities and kernel weights. It fades to 0 where there is little air, in rock
// and in caves too narrow for the air's spacing. w: share of the surroundings that is air.
vec4 flow_mean(vec4 sum)
{
    return vec4(sum.xyz / max(sum.w, 0.25), min(sum.w, 1.0));
}
