// What a voxel of which `state` is known loses, 1/kyr: its layer's rate, its own factor, and what the air in
// its bubble adds to that of a flat face (layer = rate times a, b; rate (a air - b)). Needs
// READ_V(layers) and READ_U(layer_of).

float decimation(uint state, uint slab)
{
    vec4 layer = LOAD_V(layers, LOAD_U(layer_of, slab));
    float air = float(state & 0xffffu);
    return unpackHalf2x16(state).y * max(layer.x * air - layer.y, 0.0);
}
