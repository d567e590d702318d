// What a voxel of which `state` is known loses, 1/kyr: its layer's rate, its own factor, and what the air in
// its bubble adds to that of a flat face (layer = rate times a, b; rate (a air - b)). Needs
// READ_V(layers), and voxels/layer.glsl.

float decimation(uint state, uint voxel)
{
    vec4 layer = LOAD_V(layers, layer_at(voxel));
    float air = float(state & 0xffffu);
    return unpackHalf2x16(state).y * max(layer.x * air - layer.y, 0.0);
}
