// Buffer declarations and access for every kernel. Each kernel is compiled in three variants.
//
//   declaration           the buffer is                    access
//   READ_F(0, mass)       float, read                      LOAD_F(mass, i)
//   READ_V(1, position)   vec4, read                       LOAD_V(position, i)
//   READ_U(2, start)      uint, read                       LOAD_U(start, i)
//   WRITE_F(3, sum)       float, written (or _V, _U)       AT(sum, i) = x, or atomicAdd(AT(count, i), 1u)
//
// texel     reads go through texel buffers: lavapipe gathers from these three to seven times faster than from storage buffers
// storage   storage buffers
// wide      buffer addresses, without the limits on a binding's size
//
// The build parses these declarations: write one per line. A buffer may be bound for both reading and writing in one
// dispatch only if each invocation accesses no element but its own.

#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;

#if defined(VARIANT_texel)

#define READ_F(b, name) layout(binding = b) uniform samplerBuffer name;
#define READ_V(b, name) layout(binding = b) uniform samplerBuffer name;
#define READ_U(b, name) layout(binding = b) uniform usamplerBuffer name;
#define LOAD_F(name, i) texelFetch(name, int(i)).x
#define LOAD_V(name, i) texelFetch(name, int(i))
#define LOAD_U(name, i) texelFetch(name, int(i)).x
#define WRITE_(b, name, type) layout(std430, binding = b) buffer name##_block { type d[]; } name;
#define AT(name, i) name.d[i]

#elif defined(VARIANT_storage)

#define READ_(b, name, type) layout(std430, binding = b) readonly buffer name##_block { type d[]; } name;
#define READ_F(b, name) READ_(b, name, float)
#define READ_V(b, name) READ_(b, name, vec4)
#define READ_U(b, name) READ_(b, name, uint)
#define LOAD_F(name, i) name.d[i]
#define LOAD_V(name, i) name.d[i]
#define LOAD_U(name, i) name.d[i]
#define WRITE_(b, name, type) layout(std430, binding = b) buffer name##_block { type d[]; } name;
#define AT(name, i) name.d[i]

#else // VARIANT_wide

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(std140, binding = 0) uniform addresses_block { uvec4 address[16]; };
#define REFERENCE_(b, name, type, size)                                                         \
    layout(buffer_reference, std430, buffer_reference_align = size) buffer name##_ref { type d[]; }; \
    const uint name##_binding = b;
#define READ_F(b, name) REFERENCE_(b, name, float, 4)
#define READ_V(b, name) REFERENCE_(b, name, vec4, 16)
#define READ_U(b, name) REFERENCE_(b, name, uint, 4)
#define AT(name, i) name##_ref(address[name##_binding].xy).d[i]
#define LOAD_F(name, i) AT(name, i)
#define LOAD_V(name, i) AT(name, i)
#define LOAD_U(name, i) AT(name, i)
#define WRITE_(b, name, type) READ_##type(b, name)
#define READ_float(b, name) READ_F(b, name)
#define READ_vec4(b, name) READ_V(b, name)
#define READ_uint(b, name) READ_U(b, name)

#endif

#define WRITE_F(b, name) WRITE_(b, name, float)
#define WRITE_V(b, name) WRITE_(b, name, vec4)
#define WRITE_U(b, name) WRITE_(b, name, uint)

// The kernel's parameters: a struct of shared/params.h whose first member n is the number of invocations with work to do.
#define PARAMS(type) layout(push_constant, scalar) uniform params_block { type k; };

// The index of this invocation. The dispatch is two-dimensional beyond 65535 groups.
#define THREAD (gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x))
