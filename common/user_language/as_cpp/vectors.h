// OpenCL's vectors as plain structs: a debugger prints x, y, z, and g++ takes them apart in
// vectorised loops. Several components at once are v.get<0, 1>() and v.set<0, 1>(w), which the
// texture tool writes for v.xy. Read in both C++ dialects, in the double one with `float` widened.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "platform.h"

namespace user_language {

#define TX_INLINE constexpr ALWAYS_INLINE inline

typedef signed char schar;
typedef unsigned char uchar;
typedef unsigned short ushort;
typedef unsigned int uint;
typedef unsigned long ulong;

template<class T, int N>
struct Vector;

template<class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// How many components a value brings to a vector that is put together.
template<class T>
constexpr int width_of = 1;
template<class T, int N>
constexpr int width_of<Vector<T, N>> = N;

// What a comparison of components gives: 0 or -1, an integer of their size.
template<class T>
using Truth = std::conditional_t<
    std::is_floating_point_v<T> || sizeof(T) == 4, int,
    std::conditional_t<sizeof(T) == 1, schar, std::conditional_t<sizeof(T) == 2, short, long>>>;

// Component I of the values, laid end to end.
template<int I, class A, class... Rest>
TX_INLINE auto component_of(A a, Rest... rest)
{
    if constexpr (I >= width_of<A>)
        return component_of<I - width_of<A>>(rest...);
    else if constexpr (width_of<A> == 1)
        return a;
    else
        return a.template at<I>();
}

#define TX_OPERATOR(op, name)                                                                 \
    template<std::size_t... I>                                                                \
    static TX_INLINE Vector name(Vector a, Vector b, std::index_sequence<I...>)               \
    {                                                                                         \
        return Vector(T(a.template at<I>() op b.template at<I>())...);                        \
    }                                                                                         \
    friend TX_INLINE Vector operator op(Vector a, Vector b) { return name(a, b, Indexes()); } \
    TX_INLINE Vector& operator op##=(Vector b) { return *this = name(*this, b, Indexes()); }

#define TX_COMPARISON(op, name)                                                                  \
    template<std::size_t... I>                                                                   \
    static TX_INLINE Vector<Truth<T>, Width> name(Vector a, Vector b, std::index_sequence<I...>) \
    {                                                                                            \
        return Vector<Truth<T>, Width>(                                                          \
            Truth<T>(-int(a.template at<I>() op b.template at<I>()))...);                        \
    }                                                                                            \
    friend TX_INLINE Vector<Truth<T>, Width> operator op(Vector a, Vector b)                     \
    {                                                                                            \
        return name(a, b, Indexes());                                                            \
    }

#define TX_MEMBERS(N)                                                                              \
    using Component = T;                                                                           \
    using Indexes = std::make_index_sequence<N>;                                                   \
    static constexpr int Width = N;                                                                \
    Vector() = default;                                                                            \
    template<Scalar S>                                                                             \
    TX_INLINE Vector(S s) : Vector(T(s), Indexes())                                                \
    {                                                                                              \
    }                                                                                              \
    template<std::size_t... I>                                                                     \
    TX_INLINE Vector(T s, std::index_sequence<I...>) : Vector(((void)I, s)...)                     \
    {                                                                                              \
    }                                                                                              \
    template<class... A>                                                                           \
    requires(sizeof...(A) > 1 && sizeof...(A) < N && (width_of<A> + ...) == N) TX_INLINE Vector(   \
        A... a)                                                                                    \
        : Vector(Indexes(), a...)                                                                  \
    {                                                                                              \
    }                                                                                              \
    template<std::size_t... I, class... A>                                                         \
    TX_INLINE Vector(std::index_sequence<I...>, A... a) : Vector(T(component_of<I>(a...))...)      \
    {                                                                                              \
    }                                                                                              \
    template<int... I>                                                                             \
    TX_INLINE Vector<T, sizeof...(I)> get() const                                                  \
    {                                                                                              \
        return Vector<T, sizeof...(I)>(at<I>()...);                                                \
    }                                                                                              \
    template<int... I>                                                                             \
    TX_INLINE Vector<T, sizeof...(I)> set(Vector<T, sizeof...(I)> v)                               \
    {                                                                                              \
        return assign<I...>(v, std::make_index_sequence<sizeof...(I)>());                          \
    }                                                                                              \
    template<int... I, class V, std::size_t... J>                                                  \
    TX_INLINE V assign(V v, std::index_sequence<J...>)                                             \
    {                                                                                              \
        ((at<I>() = v.template at<J>()), ...);                                                     \
        return v;                                                                                  \
    }                                                                                              \
    TX_OPERATOR(+, plus)                                                                           \
    TX_OPERATOR(-, minus)                                                                          \
    TX_OPERATOR(*, times)                                                                          \
    TX_OPERATOR(/, over)                                                                           \
    TX_OPERATOR(%, modulo)                                                                         \
    TX_OPERATOR(&, bit_and)                                                                        \
    TX_OPERATOR(|, bit_or)                                                                         \
    TX_OPERATOR(^, bit_xor)                                                                        \
    TX_OPERATOR(<<, shifted_left)                                                                  \
    TX_OPERATOR(>>, shifted_right)                                                                 \
    TX_COMPARISON(<, less)                                                                         \
    TX_COMPARISON(>, greater)                                                                      \
    TX_COMPARISON(<=, at_most)                                                                     \
    TX_COMPARISON(>=, at_least)                                                                    \
    TX_COMPARISON(==, equal)                                                                       \
    TX_COMPARISON(!=, unequal)                                                                     \
    TX_COMPARISON(&&, both)                                                                        \
    TX_COMPARISON(||, either)                                                                      \
    friend TX_INLINE Vector<Truth<T>, N> operator!(Vector a) { return equal(a, T(0), Indexes()); } \
    friend TX_INLINE Vector operator+(Vector a) { return a; }                                      \
    friend TX_INLINE Vector operator-(Vector a) { return a.negated(Indexes()); }                   \
    friend TX_INLINE Vector operator~(Vector a) { return a ^ Vector(T(-1)); }                      \
    template<std::size_t... I>                                                                     \
    TX_INLINE Vector negated(std::index_sequence<I...>) const                                      \
    {                                                                                              \
        return Vector(T(-at<I>())...);                                                             \
    }                                                                                              \
    TX_INLINE Vector& operator++() { return *this += T(1); }                                       \
    TX_INLINE Vector& operator--() { return *this -= T(1); }                                       \
    TX_INLINE Vector operator++(int)                                                               \
    {                                                                                              \
        const Vector before = *this;                                                               \
        *this += T(1);                                                                             \
        return before;                                                                             \
    }                                                                                              \
    TX_INLINE Vector operator--(int)                                                               \
    {                                                                                              \
        const Vector before = *this;                                                               \
        *this -= T(1);                                                                             \
        return before;                                                                             \
    }                                                                                              \
    template<int I>                                                                                \
    TX_INLINE T at() const                                                                         \
    {                                                                                              \
        return const_cast<Vector*>(this)->template at<I>();                                        \
    }

template<class T>
struct alignas(2 * sizeof(T)) Vector<T, 2> {
    T x, y;

    TX_INLINE Vector(T a, T b) : x(a), y(b) {}
    template<int I>
    TX_INLINE T& at()
    {
        if constexpr (I == 0)
            return x;
        else
            return y;
    }
    TX_MEMBERS(2)
};

template<class T>
struct Vector<T, 3> {
    T x, y, z;

    TX_INLINE Vector(T a, T b, T c) : x(a), y(b), z(c) {}
    template<int I>
    TX_INLINE T& at()
    {
        if constexpr (I == 0)
            return x;
        else if constexpr (I == 1)
            return y;
        else
            return z;
    }
    TX_MEMBERS(3)
};

template<class T>
struct alignas(4 * sizeof(T)) Vector<T, 4> {
    T x, y, z, w;

    TX_INLINE Vector(T a, T b, T c, T d) : x(a), y(b), z(c), w(d) {}
    template<int I>
    TX_INLINE T& at()
    {
        if constexpr (I == 0)
            return x;
        else if constexpr (I == 1)
            return y;
        else if constexpr (I == 2)
            return z;
        else
            return w;
    }
    TX_MEMBERS(4)
};

template<class T>
struct Vector<T, 8> {
    T s0, s1, s2, s3, s4, s5, s6, s7;

    TX_INLINE Vector(T a, T b, T c, T d, T e, T f, T g, T h)
        : s0(a), s1(b), s2(c), s3(d), s4(e), s5(f), s6(g), s7(h)
    {
    }
    template<int I>
    TX_INLINE T& at()
    {
        constexpr T Vector::*members[] = {&Vector::s0, &Vector::s1, &Vector::s2, &Vector::s3,
                                          &Vector::s4, &Vector::s5, &Vector::s6, &Vector::s7};
        return this->*members[I];
    }
    TX_MEMBERS(8)
};

template<class T>
struct Vector<T, 16> {
    T s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, sa, sb, sc, sd, se, sf;

    TX_INLINE Vector(T a, T b, T c, T d, T e, T f, T g, T h, T i, T j, T k, T l, T m, T n, T o, T p)
        : s0(a), s1(b), s2(c), s3(d), s4(e), s5(f), s6(g), s7(h), s8(i), s9(j), sa(k), sb(l), sc(m),
          sd(n), se(o), sf(p)
    {
    }
    template<int I>
    TX_INLINE T& at()
    {
        constexpr T Vector::*members[] = {&Vector::s0, &Vector::s1, &Vector::s2, &Vector::s3,
                                          &Vector::s4, &Vector::s5, &Vector::s6, &Vector::s7,
                                          &Vector::s8, &Vector::s9, &Vector::sa, &Vector::sb,
                                          &Vector::sc, &Vector::sd, &Vector::se, &Vector::sf};
        return this->*members[I];
    }
    TX_MEMBERS(16)
};

#define TX_VECTORS(type)             \
    typedef Vector<type, 2> type##2; \
    typedef Vector<type, 3> type##3; \
    typedef Vector<type, 4> type##4; \
    typedef Vector<type, 8> type##8; \
    typedef Vector<type, 16> type##16;
TX_VECTORS(float)
TX_VECTORS(int)
TX_VECTORS(uint)
TX_VECTORS(short)
TX_VECTORS(ushort)
TX_VECTORS(uchar)
TX_VECTORS(long)
TX_VECTORS(ulong)
typedef Vector<schar, 2> char2;
typedef Vector<schar, 3> char3;
typedef Vector<schar, 4> char4;
typedef Vector<schar, 8> char8;
typedef Vector<schar, 16> char16;

// c ? a : b for vectors: a where the highest bit of c is set.
template<class T, class C, int N, std::size_t... I>
TX_INLINE Vector<T, N> choose(Vector<C, N> c, Vector<T, N> a, Vector<T, N> b,
                              std::index_sequence<I...>)
{
    return Vector<T, N>(((std::make_signed_t<C>)c.template at<I>() < 0 ? a.template at<I>()
                                                                       : b.template at<I>())...);
}
template<class T, int N, class C>
TX_INLINE Vector<T, N> tx_choose(Vector<C, N> c, std::type_identity_t<Vector<T, N>> a,
                                 std::type_identity_t<Vector<T, N>> b)
{
    return choose<T, C, N>(c, a, b, std::make_index_sequence<N>());
}

}  // namespace user_language
