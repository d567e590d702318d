#include "stacks/material.h"

#define OF_FIELD(field) MATERIAL_AIR
#define OF_MATERIAL(material) MATERIAL_##material
#define OF_NOTHING MATERIAL_AIR
const int value_material[VALUES] = {
    OF_NOTHING,
#define VALUE(name, unit, symbol, of, from, kind, has, where, bits, layer, channels, legend, meaning) of,
#include "job/values.def"
};
