// Rate of a voxel, 1/kyr: factor * max(a air - b, 0), with air the count in `state`, and a, b its layer's rate
// times slope and level (struct bubble_rate). Needs READ_V(layers) and voxels/layer.glsl.

float decimation(uint state, uint voxel)
{
    vec4 layer = LOAD_V(layers, layer_at(voxel));
    float air = float(state & 0xffffu);
    return unpackHalf2x16(state).y * max(layer.x * air - layer.y, 0.0);
}
