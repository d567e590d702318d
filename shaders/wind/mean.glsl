// The averaged velocity from sums of velocities and weights by the kernel. Where that finds little air, in rock
// and in caves too narrow for the air's spacing, it fades to none. w: the share of space around that is air.
vec4 flow_mean(vec4 sum)
{
    return vec4(sum.xyz / max(sum.w, 0.25), min(sum.w, 1.0));
}
