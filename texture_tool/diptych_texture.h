// One header that lets a texture written for Diptych be compiled, unmodified, in anybody's program:
//
//     #include "diptych_texture.h"
//     #include "texture.c"
//
// as C11 with clang, as C++20 with g++ or clang++, and as C11 with gcc where the texture does not
// take vectors apart (gcc's C has no v.x). The program gives what a texture asks for:
//
//     void diptych_attribute(const char* name, float value[4]);        readAttr("WorldPos") ...
//     void diptych_image(sam2D image, float u, float v, unsigned flags, float value[4]);
//     float diptych_setting(const char* name);
//     float diptych_occlusion(const char* where, float distance);
//
// Mathematics is the C library's, so last digits differ from Diptych's. (float3)(a, b, c) is a
// vector in OpenCL C only; elsewhere it would silently keep c, so that it is made an error here:
// textures for other programs write make_float3(a, b, c). A function of the texture's own that has
// a library function's name and types is left out of the header by DIPTYCH_OWN_<name>, for mix,
// clamp, step, smoothstep.
#ifndef DIPTYCH_TEXTURE_H
#define DIPTYCH_TEXTURE_H

#include <math.h>
#include <string.h>

#pragma GCC diagnostic error "-Wunused-value"

typedef unsigned int uint;
typedef unsigned char uchar;
typedef unsigned short ushort;
typedef struct sam2D {
    int slot;
    const void* image;
} sam2D;
typedef sam2D sampler2D;
typedef struct SurfaceInfo SurfaceInfo;

#ifdef __cplusplus
extern "C" {
#endif
void diptych_attribute(const char* name, float value[4]);
void diptych_image(sam2D image, float u, float v, unsigned flags, float value[4]);
float diptych_setting(const char* name);
float diptych_occlusion(const char* where, float distance);
#ifdef __cplusplus
}
#endif

#define TEX_POINT_SAM 0x10000000u
#define TEX_CLAMP_U 0x40000000u
#define TEX_CLAMP_V 0x80000000u
#ifndef M_PI_F
#define M_PI_F 3.14159274f
#endif

// X(name, type)
// clang-format off
#define DIPTYCH_ATTRIBUTES(X) \
    X(WorldPos,float3) X(LocalPos,float3) X(Normal,float3) X(GeomNormal,float3) \
    X(Tangent,float3) X(Bitangent,float3) X(ViewDir,float3) X(TexCoord0,float2) \
    X(TexCoord1,float2) X(TexCoord0Dx,float2) X(TexCoord0Dy,float2) X(VertexColor,float4) \
    X(ObjectId,int) X(InstanceId,int) X(PrimitiveId,int) X(Time,float) X(Norm,float3) \
    X(ShadeNorm,float3) X(ModelPos,float3) X(Tang,float3) X(Tan,float3) X(Bitang,float3) \
    X(Bitan,float3) X(Binorm,float3) X(AO,float) X(AO0,float) X(AO1,float)
#define DIPTYCH_FUNCTIONS_1(X) \
    X(sin) X(cos) X(tan) X(asin) X(acos) X(atan) X(sinh) X(cosh) X(tanh) X(exp) X(exp2) X(log) \
    X(log2) X(log10) X(sqrt) X(cbrt) X(fabs) X(floor) X(ceil) X(trunc) X(round) X(rint) X(rsqrt) \
    X(sign) X(degrees) X(radians) X(sinpi) X(cospi) X(exp10)
#define DIPTYCH_FUNCTIONS_2(X) \
    X(atan2) X(pow) X(fmax) X(fmin) X(fmod) X(copysign) X(fdim) X(max) X(min) X(step) X(powr) \
    X(hypot)
#define DIPTYCH_FUNCTIONS_3(X) \
    X(mix) X(clamp) X(smoothstep) X(mad) X(fma)
// clang-format on

// The functions of one number under names of their own.
#define DIPTYCH_C1(name) \
    static inline float dt_##name(float x) { return name##f(x); }
#define DIPTYCH_C2(name) \
    static inline float dt_##name(float x, float y) { return name##f(x, y); }
// clang-format off
DIPTYCH_C1(sin) DIPTYCH_C1(cos) DIPTYCH_C1(tan) DIPTYCH_C1(asin) DIPTYCH_C1(acos) DIPTYCH_C1(atan)
DIPTYCH_C1(sinh) DIPTYCH_C1(cosh) DIPTYCH_C1(tanh) DIPTYCH_C1(exp) DIPTYCH_C1(exp2)
DIPTYCH_C1(log) DIPTYCH_C1(log2) DIPTYCH_C1(log10) DIPTYCH_C1(sqrt) DIPTYCH_C1(cbrt)
DIPTYCH_C1(fabs) DIPTYCH_C1(floor) DIPTYCH_C1(ceil) DIPTYCH_C1(trunc) DIPTYCH_C1(round)
DIPTYCH_C1(rint) DIPTYCH_C2(atan2) DIPTYCH_C2(pow) DIPTYCH_C2(fmax) DIPTYCH_C2(fmin)
DIPTYCH_C2(fmod) DIPTYCH_C2(copysign) DIPTYCH_C2(fdim) DIPTYCH_C2(hypot)
    // clang-format on
    static inline float dt_rsqrt(float x)
{
    return 1.0f / sqrtf(x);
}
static inline float dt_sign(float x) { return x > 0.0f ? 1.0f : (x < 0.0f ? -1.0f : 0.0f); }
static inline float dt_degrees(float x) { return x * 57.2957795f; }
static inline float dt_radians(float x) { return x * 0.0174532925f; }
static inline float dt_sinpi(float x) { return sinf(M_PI_F * fmodf(x, 2.0f)); }
static inline float dt_cospi(float x) { return cosf(M_PI_F * fmodf(x, 2.0f)); }
static inline float dt_exp10(float x) { return powf(10.0f, x); }
static inline float dt_powr(float x, float y) { return powf(x, y); }
static inline float dt_max(float x, float y) { return x < y ? y : x; }
static inline float dt_min(float x, float y) { return y < x ? y : x; }
static inline float dt_step(float edge, float x) { return x < edge ? 0.0f : 1.0f; }
static inline float dt_mix(float a, float b, float t) { return a + (b - a) * t; }
static inline float dt_clamp(float x, float a, float b) { return dt_min(dt_max(x, a), b); }
static inline float dt_mad(float a, float b, float c) { return a * b + c; }
static inline float dt_fma(float a, float b, float c) { return fmaf(a, b, c); }
static inline float dt_smoothstep(float a, float b, float x)
{
    const float t = dt_clamp((x - a) / (b - a), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

#ifdef __cplusplus
// ---- C++20
#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace diptych_texture {

template<class T, int N>
struct Vector;

// Components of a vector by name, v.zyx, where they lie.
template<class T, int N, int... I>
struct Components {
    T v[N];
    using Value = Vector<T, int(sizeof...(I))>;
    operator Value() const { return Value(v[I]...); }
    Components& operator=(const Value& w)
    {
        int k = 0;
        ((v[I] = w.v[k++]), ...);
        return *this;
    }
    Components& operator=(const Components& w) { return *this = Value(w); }
    template<class W>
    Components& operator+=(const W& w)
    {
        return *this = Value(*this) + w;
    }
    template<class W>
    Components& operator-=(const W& w)
    {
        return *this = Value(*this) - w;
    }
    template<class W>
    Components& operator*=(const W& w)
    {
        return *this = Value(*this) * w;
    }
    template<class W>
    Components& operator/=(const W& w)
    {
        return *this = Value(*this) / w;
    }
};

template<class T>
struct Shape {
    static constexpr int width = std::is_arithmetic_v<T> ? 1 : 0;
    using Number = T;
};
template<class T, int N>
struct Shape<Vector<T, N>> {
    static constexpr int width = N;
    using Number = T;
};
template<class T, int N, int... I>
struct Shape<Components<T, N, I...>> {
    static constexpr int width = sizeof...(I);
    using Number = T;
};
template<class T>
constexpr int width_of = Shape<std::remove_cvref_t<T>>::width;
template<class T>
concept Wide = (width_of<T> > 1);
template<class T>
concept Narrow = (width_of<T> == 1);
template<class T>
concept Any = (width_of<T> >= 1);

template<class A>
auto part(const A& a, int i)
{
    if constexpr (Narrow<A>)
        return a;
    else
        return Vector<typename Shape<A>::Number, width_of<A>>(a).v[i];
}

#define DIPTYCH_VECTOR(N)                                                               \
    Vector() = default;                                                                 \
    Vector(const Vector& w)                                                             \
    {                                                                                   \
        for (int i = 0; i < N; ++i) v[i] = w.v[i];                                      \
    }                                                                                   \
    Vector& operator=(const Vector& w)                                                  \
    {                                                                                   \
        for (int i = 0; i < N; ++i) v[i] = w.v[i];                                      \
        return *this;                                                                   \
    }                                                                                   \
    template<Narrow S>                                                                  \
    Vector(S s)                                                                         \
    {                                                                                   \
        for (int i = 0; i < N; ++i) v[i] = T(s);                                        \
    }                                                                                   \
    template<Any... A>                                                                  \
    requires(sizeof...(A) > 1 && (width_of<A> + ...) == N) Vector(const A&... a)        \
    {                                                                                   \
        int k = 0;                                                                      \
        const auto put = [&](const auto& one) {                                         \
            for (int i = 0; i < width_of<decltype(one)>; ++i) v[k++] = T(part(one, i)); \
        };                                                                              \
        (put(a), ...);                                                                  \
    }                                                                                   \
    T& operator[](int i) { return v[i]; }                                               \
    const T& operator[](int i) const { return v[i]; }

template<class T>
struct Vector<T, 2> {
    union {
        T v[2];
        struct {
            T x, y;
        };
        Components<T, 2, 0, 0> xx;
        Components<T, 2, 0, 1> xy;
        Components<T, 2, 1, 0> yx;
        Components<T, 2, 1, 1> yy;
        Components<T, 2, 0, 0, 0> xxx;
        Components<T, 2, 0, 0, 1> xxy;
        Components<T, 2, 0, 1, 0> xyx;
        Components<T, 2, 0, 1, 1> xyy;
        Components<T, 2, 1, 0, 0> yxx;
        Components<T, 2, 1, 0, 1> yxy;
        Components<T, 2, 1, 1, 0> yyx;
        Components<T, 2, 1, 1, 1> yyy;
        Components<T, 2, 0, 0, 0, 0> xxxx;
        Components<T, 2, 0, 0, 0, 1> xxxy;
        Components<T, 2, 0, 0, 1, 0> xxyx;
        Components<T, 2, 0, 0, 1, 1> xxyy;
        Components<T, 2, 0, 1, 0, 0> xyxx;
        Components<T, 2, 0, 1, 0, 1> xyxy;
        Components<T, 2, 0, 1, 1, 0> xyyx;
        Components<T, 2, 0, 1, 1, 1> xyyy;
        Components<T, 2, 1, 0, 0, 0> yxxx;
        Components<T, 2, 1, 0, 0, 1> yxxy;
        Components<T, 2, 1, 0, 1, 0> yxyx;
        Components<T, 2, 1, 0, 1, 1> yxyy;
        Components<T, 2, 1, 1, 0, 0> yyxx;
        Components<T, 2, 1, 1, 0, 1> yyxy;
        Components<T, 2, 1, 1, 1, 0> yyyx;
        Components<T, 2, 1, 1, 1, 1> yyyy;
    };
    DIPTYCH_VECTOR(2)
};
template<class T>
struct Vector<T, 3> {
    union {
        T v[3];
        struct {
            T x, y, z;
        };
        Components<T, 3, 0, 0> xx;
        Components<T, 3, 0, 1> xy;
        Components<T, 3, 0, 2> xz;
        Components<T, 3, 1, 0> yx;
        Components<T, 3, 1, 1> yy;
        Components<T, 3, 1, 2> yz;
        Components<T, 3, 2, 0> zx;
        Components<T, 3, 2, 1> zy;
        Components<T, 3, 2, 2> zz;
        Components<T, 3, 0, 0, 0> xxx;
        Components<T, 3, 0, 0, 1> xxy;
        Components<T, 3, 0, 0, 2> xxz;
        Components<T, 3, 0, 1, 0> xyx;
        Components<T, 3, 0, 1, 1> xyy;
        Components<T, 3, 0, 1, 2> xyz;
        Components<T, 3, 0, 2, 0> xzx;
        Components<T, 3, 0, 2, 1> xzy;
        Components<T, 3, 0, 2, 2> xzz;
        Components<T, 3, 1, 0, 0> yxx;
        Components<T, 3, 1, 0, 1> yxy;
        Components<T, 3, 1, 0, 2> yxz;
        Components<T, 3, 1, 1, 0> yyx;
        Components<T, 3, 1, 1, 1> yyy;
        Components<T, 3, 1, 1, 2> yyz;
        Components<T, 3, 1, 2, 0> yzx;
        Components<T, 3, 1, 2, 1> yzy;
        Components<T, 3, 1, 2, 2> yzz;
        Components<T, 3, 2, 0, 0> zxx;
        Components<T, 3, 2, 0, 1> zxy;
        Components<T, 3, 2, 0, 2> zxz;
        Components<T, 3, 2, 1, 0> zyx;
        Components<T, 3, 2, 1, 1> zyy;
        Components<T, 3, 2, 1, 2> zyz;
        Components<T, 3, 2, 2, 0> zzx;
        Components<T, 3, 2, 2, 1> zzy;
        Components<T, 3, 2, 2, 2> zzz;
        Components<T, 3, 0, 0, 0, 0> xxxx;
        Components<T, 3, 0, 0, 0, 1> xxxy;
        Components<T, 3, 0, 0, 0, 2> xxxz;
        Components<T, 3, 0, 0, 1, 0> xxyx;
        Components<T, 3, 0, 0, 1, 1> xxyy;
        Components<T, 3, 0, 0, 1, 2> xxyz;
        Components<T, 3, 0, 0, 2, 0> xxzx;
        Components<T, 3, 0, 0, 2, 1> xxzy;
        Components<T, 3, 0, 0, 2, 2> xxzz;
        Components<T, 3, 0, 1, 0, 0> xyxx;
        Components<T, 3, 0, 1, 0, 1> xyxy;
        Components<T, 3, 0, 1, 0, 2> xyxz;
        Components<T, 3, 0, 1, 1, 0> xyyx;
        Components<T, 3, 0, 1, 1, 1> xyyy;
        Components<T, 3, 0, 1, 1, 2> xyyz;
        Components<T, 3, 0, 1, 2, 0> xyzx;
        Components<T, 3, 0, 1, 2, 1> xyzy;
        Components<T, 3, 0, 1, 2, 2> xyzz;
        Components<T, 3, 0, 2, 0, 0> xzxx;
        Components<T, 3, 0, 2, 0, 1> xzxy;
        Components<T, 3, 0, 2, 0, 2> xzxz;
        Components<T, 3, 0, 2, 1, 0> xzyx;
        Components<T, 3, 0, 2, 1, 1> xzyy;
        Components<T, 3, 0, 2, 1, 2> xzyz;
        Components<T, 3, 0, 2, 2, 0> xzzx;
        Components<T, 3, 0, 2, 2, 1> xzzy;
        Components<T, 3, 0, 2, 2, 2> xzzz;
        Components<T, 3, 1, 0, 0, 0> yxxx;
        Components<T, 3, 1, 0, 0, 1> yxxy;
        Components<T, 3, 1, 0, 0, 2> yxxz;
        Components<T, 3, 1, 0, 1, 0> yxyx;
        Components<T, 3, 1, 0, 1, 1> yxyy;
        Components<T, 3, 1, 0, 1, 2> yxyz;
        Components<T, 3, 1, 0, 2, 0> yxzx;
        Components<T, 3, 1, 0, 2, 1> yxzy;
        Components<T, 3, 1, 0, 2, 2> yxzz;
        Components<T, 3, 1, 1, 0, 0> yyxx;
        Components<T, 3, 1, 1, 0, 1> yyxy;
        Components<T, 3, 1, 1, 0, 2> yyxz;
        Components<T, 3, 1, 1, 1, 0> yyyx;
        Components<T, 3, 1, 1, 1, 1> yyyy;
        Components<T, 3, 1, 1, 1, 2> yyyz;
        Components<T, 3, 1, 1, 2, 0> yyzx;
        Components<T, 3, 1, 1, 2, 1> yyzy;
        Components<T, 3, 1, 1, 2, 2> yyzz;
        Components<T, 3, 1, 2, 0, 0> yzxx;
        Components<T, 3, 1, 2, 0, 1> yzxy;
        Components<T, 3, 1, 2, 0, 2> yzxz;
        Components<T, 3, 1, 2, 1, 0> yzyx;
        Components<T, 3, 1, 2, 1, 1> yzyy;
        Components<T, 3, 1, 2, 1, 2> yzyz;
        Components<T, 3, 1, 2, 2, 0> yzzx;
        Components<T, 3, 1, 2, 2, 1> yzzy;
        Components<T, 3, 1, 2, 2, 2> yzzz;
        Components<T, 3, 2, 0, 0, 0> zxxx;
        Components<T, 3, 2, 0, 0, 1> zxxy;
        Components<T, 3, 2, 0, 0, 2> zxxz;
        Components<T, 3, 2, 0, 1, 0> zxyx;
        Components<T, 3, 2, 0, 1, 1> zxyy;
        Components<T, 3, 2, 0, 1, 2> zxyz;
        Components<T, 3, 2, 0, 2, 0> zxzx;
        Components<T, 3, 2, 0, 2, 1> zxzy;
        Components<T, 3, 2, 0, 2, 2> zxzz;
        Components<T, 3, 2, 1, 0, 0> zyxx;
        Components<T, 3, 2, 1, 0, 1> zyxy;
        Components<T, 3, 2, 1, 0, 2> zyxz;
        Components<T, 3, 2, 1, 1, 0> zyyx;
        Components<T, 3, 2, 1, 1, 1> zyyy;
        Components<T, 3, 2, 1, 1, 2> zyyz;
        Components<T, 3, 2, 1, 2, 0> zyzx;
        Components<T, 3, 2, 1, 2, 1> zyzy;
        Components<T, 3, 2, 1, 2, 2> zyzz;
        Components<T, 3, 2, 2, 0, 0> zzxx;
        Components<T, 3, 2, 2, 0, 1> zzxy;
        Components<T, 3, 2, 2, 0, 2> zzxz;
        Components<T, 3, 2, 2, 1, 0> zzyx;
        Components<T, 3, 2, 2, 1, 1> zzyy;
        Components<T, 3, 2, 2, 1, 2> zzyz;
        Components<T, 3, 2, 2, 2, 0> zzzx;
        Components<T, 3, 2, 2, 2, 1> zzzy;
        Components<T, 3, 2, 2, 2, 2> zzzz;
    };
    DIPTYCH_VECTOR(3)
};
template<class T>
struct Vector<T, 4> {
    union {
        T v[4];
        struct {
            T x, y, z, w;
        };
        Components<T, 4, 0, 0> xx;
        Components<T, 4, 0, 1> xy;
        Components<T, 4, 0, 2> xz;
        Components<T, 4, 0, 3> xw;
        Components<T, 4, 1, 0> yx;
        Components<T, 4, 1, 1> yy;
        Components<T, 4, 1, 2> yz;
        Components<T, 4, 1, 3> yw;
        Components<T, 4, 2, 0> zx;
        Components<T, 4, 2, 1> zy;
        Components<T, 4, 2, 2> zz;
        Components<T, 4, 2, 3> zw;
        Components<T, 4, 3, 0> wx;
        Components<T, 4, 3, 1> wy;
        Components<T, 4, 3, 2> wz;
        Components<T, 4, 3, 3> ww;
        Components<T, 4, 0, 0, 0> xxx;
        Components<T, 4, 0, 0, 1> xxy;
        Components<T, 4, 0, 0, 2> xxz;
        Components<T, 4, 0, 0, 3> xxw;
        Components<T, 4, 0, 1, 0> xyx;
        Components<T, 4, 0, 1, 1> xyy;
        Components<T, 4, 0, 1, 2> xyz;
        Components<T, 4, 0, 1, 3> xyw;
        Components<T, 4, 0, 2, 0> xzx;
        Components<T, 4, 0, 2, 1> xzy;
        Components<T, 4, 0, 2, 2> xzz;
        Components<T, 4, 0, 2, 3> xzw;
        Components<T, 4, 0, 3, 0> xwx;
        Components<T, 4, 0, 3, 1> xwy;
        Components<T, 4, 0, 3, 2> xwz;
        Components<T, 4, 0, 3, 3> xww;
        Components<T, 4, 1, 0, 0> yxx;
        Components<T, 4, 1, 0, 1> yxy;
        Components<T, 4, 1, 0, 2> yxz;
        Components<T, 4, 1, 0, 3> yxw;
        Components<T, 4, 1, 1, 0> yyx;
        Components<T, 4, 1, 1, 1> yyy;
        Components<T, 4, 1, 1, 2> yyz;
        Components<T, 4, 1, 1, 3> yyw;
        Components<T, 4, 1, 2, 0> yzx;
        Components<T, 4, 1, 2, 1> yzy;
        Components<T, 4, 1, 2, 2> yzz;
        Components<T, 4, 1, 2, 3> yzw;
        Components<T, 4, 1, 3, 0> ywx;
        Components<T, 4, 1, 3, 1> ywy;
        Components<T, 4, 1, 3, 2> ywz;
        Components<T, 4, 1, 3, 3> yww;
        Components<T, 4, 2, 0, 0> zxx;
        Components<T, 4, 2, 0, 1> zxy;
        Components<T, 4, 2, 0, 2> zxz;
        Components<T, 4, 2, 0, 3> zxw;
        Components<T, 4, 2, 1, 0> zyx;
        Components<T, 4, 2, 1, 1> zyy;
        Components<T, 4, 2, 1, 2> zyz;
        Components<T, 4, 2, 1, 3> zyw;
        Components<T, 4, 2, 2, 0> zzx;
        Components<T, 4, 2, 2, 1> zzy;
        Components<T, 4, 2, 2, 2> zzz;
        Components<T, 4, 2, 2, 3> zzw;
        Components<T, 4, 2, 3, 0> zwx;
        Components<T, 4, 2, 3, 1> zwy;
        Components<T, 4, 2, 3, 2> zwz;
        Components<T, 4, 2, 3, 3> zww;
        Components<T, 4, 3, 0, 0> wxx;
        Components<T, 4, 3, 0, 1> wxy;
        Components<T, 4, 3, 0, 2> wxz;
        Components<T, 4, 3, 0, 3> wxw;
        Components<T, 4, 3, 1, 0> wyx;
        Components<T, 4, 3, 1, 1> wyy;
        Components<T, 4, 3, 1, 2> wyz;
        Components<T, 4, 3, 1, 3> wyw;
        Components<T, 4, 3, 2, 0> wzx;
        Components<T, 4, 3, 2, 1> wzy;
        Components<T, 4, 3, 2, 2> wzz;
        Components<T, 4, 3, 2, 3> wzw;
        Components<T, 4, 3, 3, 0> wwx;
        Components<T, 4, 3, 3, 1> wwy;
        Components<T, 4, 3, 3, 2> wwz;
        Components<T, 4, 3, 3, 3> www;
        Components<T, 4, 0, 0, 0, 0> xxxx;
        Components<T, 4, 0, 0, 0, 1> xxxy;
        Components<T, 4, 0, 0, 0, 2> xxxz;
        Components<T, 4, 0, 0, 0, 3> xxxw;
        Components<T, 4, 0, 0, 1, 0> xxyx;
        Components<T, 4, 0, 0, 1, 1> xxyy;
        Components<T, 4, 0, 0, 1, 2> xxyz;
        Components<T, 4, 0, 0, 1, 3> xxyw;
        Components<T, 4, 0, 0, 2, 0> xxzx;
        Components<T, 4, 0, 0, 2, 1> xxzy;
        Components<T, 4, 0, 0, 2, 2> xxzz;
        Components<T, 4, 0, 0, 2, 3> xxzw;
        Components<T, 4, 0, 0, 3, 0> xxwx;
        Components<T, 4, 0, 0, 3, 1> xxwy;
        Components<T, 4, 0, 0, 3, 2> xxwz;
        Components<T, 4, 0, 0, 3, 3> xxww;
        Components<T, 4, 0, 1, 0, 0> xyxx;
        Components<T, 4, 0, 1, 0, 1> xyxy;
        Components<T, 4, 0, 1, 0, 2> xyxz;
        Components<T, 4, 0, 1, 0, 3> xyxw;
        Components<T, 4, 0, 1, 1, 0> xyyx;
        Components<T, 4, 0, 1, 1, 1> xyyy;
        Components<T, 4, 0, 1, 1, 2> xyyz;
        Components<T, 4, 0, 1, 1, 3> xyyw;
        Components<T, 4, 0, 1, 2, 0> xyzx;
        Components<T, 4, 0, 1, 2, 1> xyzy;
        Components<T, 4, 0, 1, 2, 2> xyzz;
        Components<T, 4, 0, 1, 2, 3> xyzw;
        Components<T, 4, 0, 1, 3, 0> xywx;
        Components<T, 4, 0, 1, 3, 1> xywy;
        Components<T, 4, 0, 1, 3, 2> xywz;
        Components<T, 4, 0, 1, 3, 3> xyww;
        Components<T, 4, 0, 2, 0, 0> xzxx;
        Components<T, 4, 0, 2, 0, 1> xzxy;
        Components<T, 4, 0, 2, 0, 2> xzxz;
        Components<T, 4, 0, 2, 0, 3> xzxw;
        Components<T, 4, 0, 2, 1, 0> xzyx;
        Components<T, 4, 0, 2, 1, 1> xzyy;
        Components<T, 4, 0, 2, 1, 2> xzyz;
        Components<T, 4, 0, 2, 1, 3> xzyw;
        Components<T, 4, 0, 2, 2, 0> xzzx;
        Components<T, 4, 0, 2, 2, 1> xzzy;
        Components<T, 4, 0, 2, 2, 2> xzzz;
        Components<T, 4, 0, 2, 2, 3> xzzw;
        Components<T, 4, 0, 2, 3, 0> xzwx;
        Components<T, 4, 0, 2, 3, 1> xzwy;
        Components<T, 4, 0, 2, 3, 2> xzwz;
        Components<T, 4, 0, 2, 3, 3> xzww;
        Components<T, 4, 0, 3, 0, 0> xwxx;
        Components<T, 4, 0, 3, 0, 1> xwxy;
        Components<T, 4, 0, 3, 0, 2> xwxz;
        Components<T, 4, 0, 3, 0, 3> xwxw;
        Components<T, 4, 0, 3, 1, 0> xwyx;
        Components<T, 4, 0, 3, 1, 1> xwyy;
        Components<T, 4, 0, 3, 1, 2> xwyz;
        Components<T, 4, 0, 3, 1, 3> xwyw;
        Components<T, 4, 0, 3, 2, 0> xwzx;
        Components<T, 4, 0, 3, 2, 1> xwzy;
        Components<T, 4, 0, 3, 2, 2> xwzz;
        Components<T, 4, 0, 3, 2, 3> xwzw;
        Components<T, 4, 0, 3, 3, 0> xwwx;
        Components<T, 4, 0, 3, 3, 1> xwwy;
        Components<T, 4, 0, 3, 3, 2> xwwz;
        Components<T, 4, 0, 3, 3, 3> xwww;
        Components<T, 4, 1, 0, 0, 0> yxxx;
        Components<T, 4, 1, 0, 0, 1> yxxy;
        Components<T, 4, 1, 0, 0, 2> yxxz;
        Components<T, 4, 1, 0, 0, 3> yxxw;
        Components<T, 4, 1, 0, 1, 0> yxyx;
        Components<T, 4, 1, 0, 1, 1> yxyy;
        Components<T, 4, 1, 0, 1, 2> yxyz;
        Components<T, 4, 1, 0, 1, 3> yxyw;
        Components<T, 4, 1, 0, 2, 0> yxzx;
        Components<T, 4, 1, 0, 2, 1> yxzy;
        Components<T, 4, 1, 0, 2, 2> yxzz;
        Components<T, 4, 1, 0, 2, 3> yxzw;
        Components<T, 4, 1, 0, 3, 0> yxwx;
        Components<T, 4, 1, 0, 3, 1> yxwy;
        Components<T, 4, 1, 0, 3, 2> yxwz;
        Components<T, 4, 1, 0, 3, 3> yxww;
        Components<T, 4, 1, 1, 0, 0> yyxx;
        Components<T, 4, 1, 1, 0, 1> yyxy;
        Components<T, 4, 1, 1, 0, 2> yyxz;
        Components<T, 4, 1, 1, 0, 3> yyxw;
        Components<T, 4, 1, 1, 1, 0> yyyx;
        Components<T, 4, 1, 1, 1, 1> yyyy;
        Components<T, 4, 1, 1, 1, 2> yyyz;
        Components<T, 4, 1, 1, 1, 3> yyyw;
        Components<T, 4, 1, 1, 2, 0> yyzx;
        Components<T, 4, 1, 1, 2, 1> yyzy;
        Components<T, 4, 1, 1, 2, 2> yyzz;
        Components<T, 4, 1, 1, 2, 3> yyzw;
        Components<T, 4, 1, 1, 3, 0> yywx;
        Components<T, 4, 1, 1, 3, 1> yywy;
        Components<T, 4, 1, 1, 3, 2> yywz;
        Components<T, 4, 1, 1, 3, 3> yyww;
        Components<T, 4, 1, 2, 0, 0> yzxx;
        Components<T, 4, 1, 2, 0, 1> yzxy;
        Components<T, 4, 1, 2, 0, 2> yzxz;
        Components<T, 4, 1, 2, 0, 3> yzxw;
        Components<T, 4, 1, 2, 1, 0> yzyx;
        Components<T, 4, 1, 2, 1, 1> yzyy;
        Components<T, 4, 1, 2, 1, 2> yzyz;
        Components<T, 4, 1, 2, 1, 3> yzyw;
        Components<T, 4, 1, 2, 2, 0> yzzx;
        Components<T, 4, 1, 2, 2, 1> yzzy;
        Components<T, 4, 1, 2, 2, 2> yzzz;
        Components<T, 4, 1, 2, 2, 3> yzzw;
        Components<T, 4, 1, 2, 3, 0> yzwx;
        Components<T, 4, 1, 2, 3, 1> yzwy;
        Components<T, 4, 1, 2, 3, 2> yzwz;
        Components<T, 4, 1, 2, 3, 3> yzww;
        Components<T, 4, 1, 3, 0, 0> ywxx;
        Components<T, 4, 1, 3, 0, 1> ywxy;
        Components<T, 4, 1, 3, 0, 2> ywxz;
        Components<T, 4, 1, 3, 0, 3> ywxw;
        Components<T, 4, 1, 3, 1, 0> ywyx;
        Components<T, 4, 1, 3, 1, 1> ywyy;
        Components<T, 4, 1, 3, 1, 2> ywyz;
        Components<T, 4, 1, 3, 1, 3> ywyw;
        Components<T, 4, 1, 3, 2, 0> ywzx;
        Components<T, 4, 1, 3, 2, 1> ywzy;
        Components<T, 4, 1, 3, 2, 2> ywzz;
        Components<T, 4, 1, 3, 2, 3> ywzw;
        Components<T, 4, 1, 3, 3, 0> ywwx;
        Components<T, 4, 1, 3, 3, 1> ywwy;
        Components<T, 4, 1, 3, 3, 2> ywwz;
        Components<T, 4, 1, 3, 3, 3> ywww;
        Components<T, 4, 2, 0, 0, 0> zxxx;
        Components<T, 4, 2, 0, 0, 1> zxxy;
        Components<T, 4, 2, 0, 0, 2> zxxz;
        Components<T, 4, 2, 0, 0, 3> zxxw;
        Components<T, 4, 2, 0, 1, 0> zxyx;
        Components<T, 4, 2, 0, 1, 1> zxyy;
        Components<T, 4, 2, 0, 1, 2> zxyz;
        Components<T, 4, 2, 0, 1, 3> zxyw;
        Components<T, 4, 2, 0, 2, 0> zxzx;
        Components<T, 4, 2, 0, 2, 1> zxzy;
        Components<T, 4, 2, 0, 2, 2> zxzz;
        Components<T, 4, 2, 0, 2, 3> zxzw;
        Components<T, 4, 2, 0, 3, 0> zxwx;
        Components<T, 4, 2, 0, 3, 1> zxwy;
        Components<T, 4, 2, 0, 3, 2> zxwz;
        Components<T, 4, 2, 0, 3, 3> zxww;
        Components<T, 4, 2, 1, 0, 0> zyxx;
        Components<T, 4, 2, 1, 0, 1> zyxy;
        Components<T, 4, 2, 1, 0, 2> zyxz;
        Components<T, 4, 2, 1, 0, 3> zyxw;
        Components<T, 4, 2, 1, 1, 0> zyyx;
        Components<T, 4, 2, 1, 1, 1> zyyy;
        Components<T, 4, 2, 1, 1, 2> zyyz;
        Components<T, 4, 2, 1, 1, 3> zyyw;
        Components<T, 4, 2, 1, 2, 0> zyzx;
        Components<T, 4, 2, 1, 2, 1> zyzy;
        Components<T, 4, 2, 1, 2, 2> zyzz;
        Components<T, 4, 2, 1, 2, 3> zyzw;
        Components<T, 4, 2, 1, 3, 0> zywx;
        Components<T, 4, 2, 1, 3, 1> zywy;
        Components<T, 4, 2, 1, 3, 2> zywz;
        Components<T, 4, 2, 1, 3, 3> zyww;
        Components<T, 4, 2, 2, 0, 0> zzxx;
        Components<T, 4, 2, 2, 0, 1> zzxy;
        Components<T, 4, 2, 2, 0, 2> zzxz;
        Components<T, 4, 2, 2, 0, 3> zzxw;
        Components<T, 4, 2, 2, 1, 0> zzyx;
        Components<T, 4, 2, 2, 1, 1> zzyy;
        Components<T, 4, 2, 2, 1, 2> zzyz;
        Components<T, 4, 2, 2, 1, 3> zzyw;
        Components<T, 4, 2, 2, 2, 0> zzzx;
        Components<T, 4, 2, 2, 2, 1> zzzy;
        Components<T, 4, 2, 2, 2, 2> zzzz;
        Components<T, 4, 2, 2, 2, 3> zzzw;
        Components<T, 4, 2, 2, 3, 0> zzwx;
        Components<T, 4, 2, 2, 3, 1> zzwy;
        Components<T, 4, 2, 2, 3, 2> zzwz;
        Components<T, 4, 2, 2, 3, 3> zzww;
        Components<T, 4, 2, 3, 0, 0> zwxx;
        Components<T, 4, 2, 3, 0, 1> zwxy;
        Components<T, 4, 2, 3, 0, 2> zwxz;
        Components<T, 4, 2, 3, 0, 3> zwxw;
        Components<T, 4, 2, 3, 1, 0> zwyx;
        Components<T, 4, 2, 3, 1, 1> zwyy;
        Components<T, 4, 2, 3, 1, 2> zwyz;
        Components<T, 4, 2, 3, 1, 3> zwyw;
        Components<T, 4, 2, 3, 2, 0> zwzx;
        Components<T, 4, 2, 3, 2, 1> zwzy;
        Components<T, 4, 2, 3, 2, 2> zwzz;
        Components<T, 4, 2, 3, 2, 3> zwzw;
        Components<T, 4, 2, 3, 3, 0> zwwx;
        Components<T, 4, 2, 3, 3, 1> zwwy;
        Components<T, 4, 2, 3, 3, 2> zwwz;
        Components<T, 4, 2, 3, 3, 3> zwww;
        Components<T, 4, 3, 0, 0, 0> wxxx;
        Components<T, 4, 3, 0, 0, 1> wxxy;
        Components<T, 4, 3, 0, 0, 2> wxxz;
        Components<T, 4, 3, 0, 0, 3> wxxw;
        Components<T, 4, 3, 0, 1, 0> wxyx;
        Components<T, 4, 3, 0, 1, 1> wxyy;
        Components<T, 4, 3, 0, 1, 2> wxyz;
        Components<T, 4, 3, 0, 1, 3> wxyw;
        Components<T, 4, 3, 0, 2, 0> wxzx;
        Components<T, 4, 3, 0, 2, 1> wxzy;
        Components<T, 4, 3, 0, 2, 2> wxzz;
        Components<T, 4, 3, 0, 2, 3> wxzw;
        Components<T, 4, 3, 0, 3, 0> wxwx;
        Components<T, 4, 3, 0, 3, 1> wxwy;
        Components<T, 4, 3, 0, 3, 2> wxwz;
        Components<T, 4, 3, 0, 3, 3> wxww;
        Components<T, 4, 3, 1, 0, 0> wyxx;
        Components<T, 4, 3, 1, 0, 1> wyxy;
        Components<T, 4, 3, 1, 0, 2> wyxz;
        Components<T, 4, 3, 1, 0, 3> wyxw;
        Components<T, 4, 3, 1, 1, 0> wyyx;
        Components<T, 4, 3, 1, 1, 1> wyyy;
        Components<T, 4, 3, 1, 1, 2> wyyz;
        Components<T, 4, 3, 1, 1, 3> wyyw;
        Components<T, 4, 3, 1, 2, 0> wyzx;
        Components<T, 4, 3, 1, 2, 1> wyzy;
        Components<T, 4, 3, 1, 2, 2> wyzz;
        Components<T, 4, 3, 1, 2, 3> wyzw;
        Components<T, 4, 3, 1, 3, 0> wywx;
        Components<T, 4, 3, 1, 3, 1> wywy;
        Components<T, 4, 3, 1, 3, 2> wywz;
        Components<T, 4, 3, 1, 3, 3> wyww;
        Components<T, 4, 3, 2, 0, 0> wzxx;
        Components<T, 4, 3, 2, 0, 1> wzxy;
        Components<T, 4, 3, 2, 0, 2> wzxz;
        Components<T, 4, 3, 2, 0, 3> wzxw;
        Components<T, 4, 3, 2, 1, 0> wzyx;
        Components<T, 4, 3, 2, 1, 1> wzyy;
        Components<T, 4, 3, 2, 1, 2> wzyz;
        Components<T, 4, 3, 2, 1, 3> wzyw;
        Components<T, 4, 3, 2, 2, 0> wzzx;
        Components<T, 4, 3, 2, 2, 1> wzzy;
        Components<T, 4, 3, 2, 2, 2> wzzz;
        Components<T, 4, 3, 2, 2, 3> wzzw;
        Components<T, 4, 3, 2, 3, 0> wzwx;
        Components<T, 4, 3, 2, 3, 1> wzwy;
        Components<T, 4, 3, 2, 3, 2> wzwz;
        Components<T, 4, 3, 2, 3, 3> wzww;
        Components<T, 4, 3, 3, 0, 0> wwxx;
        Components<T, 4, 3, 3, 0, 1> wwxy;
        Components<T, 4, 3, 3, 0, 2> wwxz;
        Components<T, 4, 3, 3, 0, 3> wwxw;
        Components<T, 4, 3, 3, 1, 0> wwyx;
        Components<T, 4, 3, 3, 1, 1> wwyy;
        Components<T, 4, 3, 3, 1, 2> wwyz;
        Components<T, 4, 3, 3, 1, 3> wwyw;
        Components<T, 4, 3, 3, 2, 0> wwzx;
        Components<T, 4, 3, 3, 2, 1> wwzy;
        Components<T, 4, 3, 3, 2, 2> wwzz;
        Components<T, 4, 3, 3, 2, 3> wwzw;
        Components<T, 4, 3, 3, 3, 0> wwwx;
        Components<T, 4, 3, 3, 3, 1> wwwy;
        Components<T, 4, 3, 3, 3, 2> wwwz;
        Components<T, 4, 3, 3, 3, 3> wwww;
    };
    DIPTYCH_VECTOR(4)
};

#define DIPTYCH_OPERATOR(op)                                                              \
    template<Any A, Any B>                                                                \
    requires(Wide<A> || Wide<B>) auto operator op(const A& a, const B& b)                 \
    {                                                                                     \
        using W = std::conditional_t<Wide<A>, A, B>;                                      \
        using T = typename Shape<W>::Number;                                              \
        Vector<T, width_of<W>> r;                                                         \
        for (int i = 0; i < width_of<W>; ++i) r.v[i] = T(T(part(a, i)) op T(part(b, i))); \
        return r;                                                                         \
    }                                                                                     \
    template<class T, int N, Any B>                                                       \
    Vector<T, N>& operator op##=(Vector<T, N>& a, const B& b)                             \
    {                                                                                     \
        return a = a op b;                                                                \
    }
DIPTYCH_OPERATOR(+)
DIPTYCH_OPERATOR(-)
DIPTYCH_OPERATOR(*)
DIPTYCH_OPERATOR(/)
DIPTYCH_OPERATOR(%)
DIPTYCH_OPERATOR(&)
DIPTYCH_OPERATOR(|)
DIPTYCH_OPERATOR(^)
DIPTYCH_OPERATOR(<<)
DIPTYCH_OPERATOR(>>)
#define DIPTYCH_COMPARISON(op)                                            \
    template<Any A, Any B>                                                \
    requires(Wide<A> || Wide<B>) auto operator op(const A& a, const B& b) \
    {                                                                     \
        Vector<int, width_of<std::conditional_t<Wide<A>, A, B>>> r;       \
        for (int i = 0; i < width_of<decltype(r)>; ++i)                   \
            r.v[i] = part(a, i) op part(b, i) ? -1 : 0;                   \
        return r;                                                         \
    }
DIPTYCH_COMPARISON(<)
DIPTYCH_COMPARISON(>)
DIPTYCH_COMPARISON(<=)
DIPTYCH_COMPARISON(>=)
DIPTYCH_COMPARISON(==)
DIPTYCH_COMPARISON(!=)
template<Wide A>
auto operator-(const A& a)
{
    return typename Shape<A>::Number(0) - a;
}

typedef Vector<float, 2> float2;
typedef Vector<float, 3> float3;
typedef Vector<float, 4> float4;
typedef Vector<int, 2> int2;
typedef Vector<int, 3> int3;
typedef Vector<int, 4> int4;
typedef Vector<uint, 2> uint2;
typedef Vector<uint, 3> uint3;
typedef Vector<uint, 4> uint4;

#define DIPTYCH_WIDE_1(name)                                                  \
    template<Wide A>                                                          \
    auto name(const A& a)                                                     \
    {                                                                         \
        Vector<float, width_of<A>> r;                                         \
        for (int i = 0; i < width_of<A>; ++i) r.v[i] = dt_##name(part(a, i)); \
        return r;                                                             \
    }
#define DIPTYCH_WIDE_2(name)                                          \
    template<Any A, Any B>                                            \
    requires(Wide<A> || Wide<B>) auto name(const A& a, const B& b)    \
    {                                                                 \
        Vector<float, std::max(width_of<A>, width_of<B>)> r;          \
        for (int i = 0; i < width_of<decltype(r)>; ++i)               \
            r.v[i] = dt_##name(float(part(a, i)), float(part(b, i))); \
        return r;                                                     \
    }
#define DIPTYCH_WIDE_3(name)                                                              \
    template<Any A, Any B, Any C>                                                         \
    requires(Wide<A> || Wide<B> || Wide<C>) auto name(const A& a, const B& b, const C& c) \
    {                                                                                     \
        Vector<float, std::max({width_of<A>, width_of<B>, width_of<C>})> r;               \
        for (int i = 0; i < width_of<decltype(r)>; ++i)                                   \
            r.v[i] = dt_##name(float(part(a, i)), float(part(b, i)), float(part(c, i)));  \
        return r;                                                                         \
    }
DIPTYCH_FUNCTIONS_1(DIPTYCH_WIDE_1)
DIPTYCH_FUNCTIONS_2(DIPTYCH_WIDE_2)
DIPTYCH_FUNCTIONS_3(DIPTYCH_WIDE_3)

// Of numbers, where the C library has none; templates, so that a texture's own function wins.
#define DIPTYCH_NARROW_1(name)      \
    template<Narrow A>              \
    float name(A a)                 \
    {                               \
        return dt_##name(float(a)); \
    }
#define DIPTYCH_NARROW_2(name)                                                                    \
    template<Narrow A, Narrow B>                                                                  \
    std::common_type_t<A, B, std::conditional_t<std::is_floating_point_v<A>, float, A>> name(A a, \
                                                                                             B b) \
    {                                                                                             \
        return dt_##name(float(a), float(b));                                                     \
    }
#define DIPTYCH_NARROW_3(name)                          \
    template<Narrow A, Narrow B, Narrow C>              \
    float name(A a, B b, C c)                           \
    {                                                   \
        return dt_##name(float(a), float(b), float(c)); \
    }
DIPTYCH_NARROW_1(rsqrt)
DIPTYCH_NARROW_1(sign)
DIPTYCH_NARROW_1(degrees)
DIPTYCH_NARROW_1(radians)
DIPTYCH_NARROW_1(sinpi)
DIPTYCH_NARROW_1(cospi)
DIPTYCH_NARROW_2(max)
DIPTYCH_NARROW_2(min)
DIPTYCH_NARROW_2(step)
DIPTYCH_NARROW_3(mix)
DIPTYCH_NARROW_3(clamp)
DIPTYCH_NARROW_3(smoothstep)
DIPTYCH_NARROW_3(mad)

template<Wide A, Wide B>
float dot(const A& a, const B& b)
{
    float sum = 0.0f;
    for (int i = 0; i < width_of<A>; ++i) sum += part(a, i) * part(b, i);
    return sum;
}
template<Wide A>
float length(const A& a)
{
    return sqrtf(dot(a, a));
}
template<Wide A, Wide B>
float distance(const A& a, const B& b)
{
    return length(a - b);
}
template<Wide A>
auto normalize(const A& a)
{
    const float size = length(a);
    return a * (1.0f / (size > 0.0f ? size : 1.0f));
}
inline float3 cross(const float3& a, const float3& b)
{
    return float3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
inline float2 make_float2(float x, float y) { return float2(x, y); }
inline float3 make_float3(float x, float y, float z) { return float3(x, y, z); }
inline float4 make_float4(float x, float y, float z, float w) { return float4(x, y, z, w); }
inline float3 to_float3(const float4& v) { return float3(v.v[0], v.v[1], v.v[2]); }
inline float4 to_float4(const float3& v, float w) { return float4(v, w); }
inline uint as_uint(float x) { return __builtin_bit_cast(uint, x); }
inline int as_int(float x) { return __builtin_bit_cast(int, x); }
inline float as_float(uint x) { return __builtin_bit_cast(float, x); }
inline float as_float(int x) { return __builtin_bit_cast(float, x); }

// A name that chooses a type.
template<std::size_t N>
struct Name {
    char text[N] = {};
    consteval Name(const char (&name)[N]) { std::copy_n(name, N, text); }
    constexpr bool is(const char* other) const
    {
        std::size_t i = 0;
        while (i < N && text[i] == other[i] && text[i] != 0) ++i;
        return i < N && text[i] == other[i];
    }
};
template<class T>
T from_floats(const float* value)
{
    if constexpr (width_of<T> == 1) {
        return T(value[0]);
    } else {
        T result;
        for (int i = 0; i < width_of<T>; ++i) result.v[i] = value[i];
        return result;
    }
}
template<Name name>
auto read_attribute()
{
    float value[4] = {};
    diptych_attribute(name.text, value);
#define DIPTYCH_READ(attribute, type)    \
    if constexpr (name.is(#attribute))   \
        return from_floats<type>(value); \
    else
    DIPTYCH_ATTRIBUTES(DIPTYCH_READ)
    {
        static_assert(name.is("WorldPos"), "readAttr: unknown attribute");
    }
}
#define readAttr(...)                                       \
    (diptych_texture::read_attribute<diptych_texture::Name( \
         DIPTYCH_PICK(__VA_ARGS__, __VA_ARGS__, ))>())
#define DIPTYCH_PICK(a, b, c, ...) DIPTYCH_PICK_(a, b, c)
#define DIPTYCH_PICK_(a, b, c) b

inline float4 tex2D(sam2D image, const float2& uv)
{
    float4 value;
    diptych_image(image, uv.v[0], uv.v[1], 0, value.v);
    return value;
}
inline float4 texture2D(sam2D image, const float2& uv, unsigned flags = 0)
{
    float4 value;
    diptych_image(image, uv.v[0], uv.v[1], flags, value.v);
    return value;
}
inline float readSetting(const char* name) { return diptych_setting(name); }
inline float readOcclusion(const char* where, float distance)
{
    return diptych_occlusion(where, distance);
}

}  // namespace diptych_texture

using namespace diptych_texture;
#else
// ---- C11
#ifdef __clang__
#define DIPTYCH_VECTOR_TYPE(type, n) typedef type type##n __attribute__((ext_vector_type(n)));
#else
#define DIPTYCH_VECTOR_TYPE(type, n) \
    typedef type type##n __attribute__((vector_size(n == 3 ? 16 : 4 * n)));
#endif
DIPTYCH_VECTOR_TYPE(float, 2)
DIPTYCH_VECTOR_TYPE(float, 3)
DIPTYCH_VECTOR_TYPE(float, 4)
DIPTYCH_VECTOR_TYPE(int, 2)
DIPTYCH_VECTOR_TYPE(int, 3)
DIPTYCH_VECTOR_TYPE(int, 4)
DIPTYCH_VECTOR_TYPE(uint, 2)
DIPTYCH_VECTOR_TYPE(uint, 3)
DIPTYCH_VECTOR_TYPE(uint, 4)

static inline float2 make_float2(float x, float y) { return (float2){x, y}; }
static inline float3 make_float3(float x, float y, float z) { return (float3){x, y, z}; }
static inline float4 make_float4(float x, float y, float z, float w)
{
    return (float4){x, y, z, w};
}
static inline float3 to_float3(float4 v) { return (float3){v[0], v[1], v[2]}; }
static inline float4 to_float4(float3 v, float w) { return (float4){v[0], v[1], v[2], w}; }
static inline uint as_uint(float x)
{
    uint r;
    memcpy(&r, &x, 4);
    return r;
}
static inline int as_int(float x)
{
    int r;
    memcpy(&r, &x, 4);
    return r;
}
static inline float readSetting(const char* name) { return diptych_setting(name); }
static inline float readOcclusion(const char* where, float distance)
{
    return diptych_occlusion(where, distance);
}
static inline float4 diptych_fetch(sam2D image, float2 uv, unsigned flags)
{
    float value[4];
    diptych_image(image, uv[0], uv[1], flags, value);
    return (float4){value[0], value[1], value[2], value[3]};
}
static inline float4 tex2D(sam2D image, float2 uv) { return diptych_fetch(image, uv, 0); }
#define texture2D(image, uv, flags) diptych_fetch(image, uv, flags)

static inline float3 diptych_float3(const char* name)
{
    float value[4] = {0};
    diptych_attribute(name, value);
    return (float3){value[0], value[1], value[2]};
}
static inline float2 diptych_float2(const char* name)
{
    float value[4] = {0};
    diptych_attribute(name, value);
    return (float2){value[0], value[1]};
}
static inline float4 diptych_float4(const char* name)
{
    float value[4] = {0};
    diptych_attribute(name, value);
    return (float4){value[0], value[1], value[2], value[3]};
}
static inline float diptych_float(const char* name)
{
    float value[4] = {0};
    diptych_attribute(name, value);
    return value[0];
}
static inline int diptych_int(const char* name) { return (int)diptych_float(name); }
#define DIPTYCH_IS(name, other) (__builtin_strcmp(name, other) == 0)
void diptych_unknown_attribute(void);
#define DIPTYCH_READ(name)                                                                                                         \
    __builtin_choose_expr(                                                                                                         \
        DIPTYCH_IS(name, "WorldPos"), diptych_float3(name),                                                                        \
        __builtin_choose_expr(                                                                                                     \
            DIPTYCH_IS(name, "LocalPos"), diptych_float3(name),                                                                    \
            __builtin_choose_expr(                                                                                                 \
                DIPTYCH_IS(name, "Normal"), diptych_float3(name),                                                                  \
                __builtin_choose_expr(                                                                                             \
                    DIPTYCH_IS(name, "GeomNormal"), diptych_float3(name),                                                          \
                    __builtin_choose_expr(                                                                                         \
                        DIPTYCH_IS(name, "Tangent"), diptych_float3(name),                                                         \
                        __builtin_choose_expr(                                                                                     \
                            DIPTYCH_IS(name, "Bitangent"), diptych_float3(name),                                                   \
                            __builtin_choose_expr(                                                                                 \
                                DIPTYCH_IS(name, "ViewDir"), diptych_float3(name),                                                 \
                                __builtin_choose_expr(                                                                             \
                                    DIPTYCH_IS(name, "TexCoord0"), diptych_float2(name),                                           \
                                    __builtin_choose_expr(                                                                         \
                                        DIPTYCH_IS(name, "TexCoord1"), diptych_float2(name),                                       \
                                        __builtin_choose_expr(                                                                     \
                                            DIPTYCH_IS(name, "TexCoord0Dx"), diptych_float2(name),                                 \
                                            __builtin_choose_expr(                                                                 \
                                                DIPTYCH_IS(name, "TexCoord0Dy"),                                                   \
                                                diptych_float2(name),                                                              \
                                                __builtin_choose_expr(                                                             \
                                                    DIPTYCH_IS(name, "VertexColor"),                                               \
                                                    diptych_float4(name),                                                          \
                                                    __builtin_choose_expr(                                                         \
                                                        DIPTYCH_IS(name, "ObjectId"),                                              \
                                                        diptych_int(name),                                                         \
                                                        __builtin_choose_expr(                                                     \
                                                            DIPTYCH_IS(name, "InstanceId"),                                        \
                                                            diptych_int(name),                                                     \
                                                            __builtin_choose_expr(                                                 \
                                                                DIPTYCH_IS(name, "PrimitiveId"),                                   \
                                                                diptych_int(name),                                                 \
                                                                __builtin_choose_expr(                                             \
                                                                    DIPTYCH_IS(name, "Time"),                                      \
                                                                    diptych_float(name),                                           \
                                                                    __builtin_choose_expr(                                         \
                                                                        DIPTYCH_IS(name, "Norm"),                                  \
                                                                        diptych_float3(name),                                      \
                                                                        __builtin_choose_expr(                                     \
                                                                            DIPTYCH_IS(                                            \
                                                                                name,                                              \
                                                                                "ShadeNorm"),                                      \
                                                                            diptych_float3(name),                                  \
                                                                            __builtin_choose_expr(                                 \
                                                                                DIPTYCH_IS(                                        \
                                                                                    name,                                          \
                                                                                    "ModelPos"),                                   \
                                                                                diptych_float3(                                    \
                                                                                    name),                                         \
                                                                                __builtin_choose_expr(                             \
                                                                                    DIPTYCH_IS(                                    \
                                                                                        name,                                      \
                                                                                        "Tang"),                                   \
                                                                                    diptych_float3(                                \
                                                                                        name),                                     \
                                                                                    __builtin_choose_expr(                         \
                                                                                        DIPTYCH_IS(                                \
                                                                                            name,                                  \
                                                                                            "Ta"                                   \
                                                                                            "n"),                                  \
                                                                                        diptych_float3(                            \
                                                                                            name),                                 \
                                                                                        __builtin_choose_expr(                     \
                                                                                            DIPTYCH_IS(                            \
                                                                                                name,                              \
                                                                                                "Bitang"),                         \
                                                                                            diptych_float3(                        \
                                                                                                name),                             \
                                                                                            __builtin_choose_expr(                 \
                                                                                                DIPTYCH_IS(                        \
                                                                                                    name,                          \
                                                                                                    "Bitan"),                      \
                                                                                                diptych_float3(                    \
                                                                                                    name),                         \
                                                                                                __builtin_choose_expr(             \
                                                                                                    DIPTYCH_IS(                    \
                                                                                                        name,                      \
                                                                                                        "Binorm"),                 \
                                                                                                    diptych_float3(                \
                                                                                                        name),                     \
                                                                                                    __builtin_choose_expr(         \
                                                                                                        DIPTYCH_IS(                \
                                                                                                            name,                  \
                                                                                                            "AO"),                 \
                                                                                                        diptych_float(             \
                                                                                                            name),                 \
                                                                                                        __builtin_choose_expr(     \
                                                                                                            DIPTYCH_IS(            \
                                                                                                                name,              \
                                                                                                                "AO0"),            \
                                                                                                            diptych_float(         \
                                                                                                                name),             \
                                                                                                            __builtin_choose_expr( \
                                                                                                                DIPTYCH_IS(        \
                                                                                                                    name,          \
                                                                                                                    "AO1"),        \
                                                                                                                diptych_float(     \
                                                                                                                    name),         \
                                                                                                                diptych_unknown_attribute())))))))))))))))))))))))))))
#define readAttr(...) DIPTYCH_READ(DIPTYCH_LAST_OF_TWO(__VA_ARGS__, __VA_ARGS__, ))
#define DIPTYCH_LAST_OF_TWO(a, b, ...) b

#ifdef __clang__
#define DIPTYCH_MANY static inline __attribute__((overloadable))
#define DIPTYCH_W1(name, n)                                 \
    DIPTYCH_MANY float##n dv_##name(float##n a)             \
    {                                                       \
        float##n r;                                         \
        for (int i = 0; i < n; ++i) r[i] = dt_##name(a[i]); \
        return r;                                           \
    }
#define DIPTYCH_W2(name, n)                                       \
    DIPTYCH_MANY float##n dv_##name(float##n a, float##n b)       \
    {                                                             \
        float##n r;                                               \
        for (int i = 0; i < n; ++i) r[i] = dt_##name(a[i], b[i]); \
        return r;                                                 \
    }
#define DIPTYCH_W3(name, n)                                             \
    DIPTYCH_MANY float##n dv_##name(float##n a, float##n b, float##n c) \
    {                                                                   \
        float##n r;                                                     \
        for (int i = 0; i < n; ++i) r[i] = dt_##name(a[i], b[i], c[i]); \
        return r;                                                       \
    }
#define DIPTYCH_ALL_1(name)                                        \
    DIPTYCH_MANY float dv_##name(float a) { return dt_##name(a); } \
    DIPTYCH_W1(name, 2) DIPTYCH_W1(name, 3) DIPTYCH_W1(name, 4)
#define DIPTYCH_ALL_2(name)                                                    \
    DIPTYCH_MANY float dv_##name(float a, float b) { return dt_##name(a, b); } \
    DIPTYCH_W2(name, 2) DIPTYCH_W2(name, 3) DIPTYCH_W2(name, 4)
#define DIPTYCH_ALL_3(name)                                                                \
    DIPTYCH_MANY float dv_##name(float a, float b, float c) { return dt_##name(a, b, c); } \
    DIPTYCH_W3(name, 2) DIPTYCH_W3(name, 3) DIPTYCH_W3(name, 4)
DIPTYCH_FUNCTIONS_1(DIPTYCH_ALL_1)
DIPTYCH_FUNCTIONS_2(DIPTYCH_ALL_2)
DIPTYCH_FUNCTIONS_3(DIPTYCH_ALL_3)
#define DIPTYCH_G(n)                                                              \
    DIPTYCH_MANY float dot(float##n a, float##n b)                                \
    {                                                                             \
        float sum = 0.0f;                                                         \
        for (int i = 0; i < n; ++i) sum += a[i] * b[i];                           \
        return sum;                                                               \
    }                                                                             \
    DIPTYCH_MANY float length(float##n a) { return sqrtf(dot(a, a)); }            \
    DIPTYCH_MANY float distance(float##n a, float##n b) { return length(a - b); } \
    DIPTYCH_MANY float##n normalize(float##n a)                                   \
    {                                                                             \
        const float size = length(a);                                             \
        return a * (1.0f / (size > 0.0f ? size : 1.0f));                          \
    }
DIPTYCH_G(2) DIPTYCH_G(3) DIPTYCH_G(4) static inline float3 cross(float3 a, float3 b)
{
    return (float3){a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]};
}
#define sin(x) dv_sin(x)
#define cos(x) dv_cos(x)
#define tan(x) dv_tan(x)
#define asin(x) dv_asin(x)
#define acos(x) dv_acos(x)
#define atan(x) dv_atan(x)
#define sinh(x) dv_sinh(x)
#define cosh(x) dv_cosh(x)
#define tanh(x) dv_tanh(x)
#define exp(x) dv_exp(x)
#define exp2(x) dv_exp2(x)
#define log(x) dv_log(x)
#define log2(x) dv_log2(x)
#define log10(x) dv_log10(x)
#define sqrt(x) dv_sqrt(x)
#define cbrt(x) dv_cbrt(x)
#define fabs(x) dv_fabs(x)
#define floor(x) dv_floor(x)
#define ceil(x) dv_ceil(x)
#define trunc(x) dv_trunc(x)
#define round(x) dv_round(x)
#define rint(x) dv_rint(x)
#define rsqrt(x) dv_rsqrt(x)
#define sign(x) dv_sign(x)
#define degrees(x) dv_degrees(x)
#define radians(x) dv_radians(x)
#define sinpi(x) dv_sinpi(x)
#define cospi(x) dv_cospi(x)
#define exp10(x) dv_exp10(x)
#define atan2(x, y) dv_atan2(x, y)
#define pow(x, y) dv_pow(x, y)
#define fmax(x, y) dv_fmax(x, y)
#define fmin(x, y) dv_fmin(x, y)
#define fmod(x, y) dv_fmod(x, y)
#define copysign(x, y) dv_copysign(x, y)
#define fdim(x, y) dv_fdim(x, y)
#define max(x, y) dv_max(x, y)
#define min(x, y) dv_min(x, y)
#define step(x, y) dv_step(x, y)
#define powr(x, y) dv_powr(x, y)
#define hypot(x, y) dv_hypot(x, y)
#ifndef DIPTYCH_OWN_mix
#define mix(x, y, z) dv_mix(x, y, z)
#endif
#ifndef DIPTYCH_OWN_clamp
#define clamp(x, y, z) dv_clamp(x, y, z)
#endif
#ifndef DIPTYCH_OWN_smoothstep
#define smoothstep(x, y, z) dv_smoothstep(x, y, z)
#endif
#define mad(x, y, z) dv_mad(x, y, z)
#define fma(x, y, z) dv_fma(x, y, z)
#else
#define sin(x) dt_sin(x)
#define cos(x) dt_cos(x)
#define tan(x) dt_tan(x)
#define asin(x) dt_asin(x)
#define acos(x) dt_acos(x)
#define atan(x) dt_atan(x)
#define sinh(x) dt_sinh(x)
#define cosh(x) dt_cosh(x)
#define tanh(x) dt_tanh(x)
#define exp(x) dt_exp(x)
#define exp2(x) dt_exp2(x)
#define log(x) dt_log(x)
#define log2(x) dt_log2(x)
#define log10(x) dt_log10(x)
#define sqrt(x) dt_sqrt(x)
#define cbrt(x) dt_cbrt(x)
#define fabs(x) dt_fabs(x)
#define floor(x) dt_floor(x)
#define ceil(x) dt_ceil(x)
#define trunc(x) dt_trunc(x)
#define round(x) dt_round(x)
#define rint(x) dt_rint(x)
#define rsqrt(x) dt_rsqrt(x)
#define sign(x) dt_sign(x)
#define degrees(x) dt_degrees(x)
#define radians(x) dt_radians(x)
#define sinpi(x) dt_sinpi(x)
#define cospi(x) dt_cospi(x)
#define exp10(x) dt_exp10(x)
#define atan2(x, y) dt_atan2(x, y)
#define pow(x, y) dt_pow(x, y)
#define fmax(x, y) dt_fmax(x, y)
#define fmin(x, y) dt_fmin(x, y)
#define fmod(x, y) dt_fmod(x, y)
#define copysign(x, y) dt_copysign(x, y)
#define fdim(x, y) dt_fdim(x, y)
#define max(x, y) dt_max(x, y)
#define min(x, y) dt_min(x, y)
#define step(x, y) dt_step(x, y)
#define powr(x, y) dt_powr(x, y)
#define hypot(x, y) dt_hypot(x, y)
#ifndef DIPTYCH_OWN_mix
#define mix(x, y, z) dt_mix(x, y, z)
#endif
#ifndef DIPTYCH_OWN_clamp
#define clamp(x, y, z) dt_clamp(x, y, z)
#endif
#ifndef DIPTYCH_OWN_smoothstep
#define smoothstep(x, y, z) dt_smoothstep(x, y, z)
#endif
#define mad(x, y, z) dt_mad(x, y, z)
#define fma(x, y, z) dt_fma(x, y, z)
#endif
#endif

#endif
