// What the texture tool's text calls besides the language itself: arguments out of a region of the
// material buffer, arrays behind bounds, the loop budget. Read in the scope of the vector types,
// after struct TextureContext (with `int budget, fault_line, clamped`) and these two:
//
//     uint tx_word(TextureContext* tx, int index)      a word of the material buffer
//     float4 tx_stack(TextureContext* tx, int slot)    another node's result; slot 0 always exists
//
// Word r + 4k of region r describes argument k: its source (-1: constant, else the stack slot),
// the word where its value begins, its length.
#pragma once

// An index into an array of n elements, brought inside and counted where it was not.
SHARED int tx_index(TextureContext* tx, int i, int n)
{
    const int above = i < 0 ? 0 : i;
    const int inside = above < n ? above : n - 1;
    tx->clamped += inside != i ? 1 : 0;
    return inside;
}

// Whether the loop at `line` may go round again; the first that may not is remembered.
SHARED int tx_spend(TextureContext* tx, int line)
{
    const int may = tx->budget > 0;
    tx->budget -= may ? 1 : 0;
    tx->fault_line = may || tx->fault_line != 0 ? tx->fault_line : line;
    return may;
}

SHARED float tx_load_float(TextureContext* tx, int at) { return as_float(tx_word(tx, at)); }
SHARED int tx_load_int(TextureContext* tx, int at) { return (int)tx_word(tx, at); }
SHARED uint tx_load_uint(TextureContext* tx, int at) { return tx_word(tx, at); }
SHARED sam2D tx_load_sam2D(TextureContext* tx, int at)
{
    sam2D image;
    image.number = (int)tx_word(tx, at) + 1;
    return image;
}
#define TX_LOADS(T)                                                                                \
    SHARED T##2 tx_load_##T##2(TextureContext * tx, int at)                                        \
    {                                                                                              \
        return TX_NEW(T##2, tx_load_##T(tx, at), tx_load_##T(tx, at + 1));                         \
    }                                                                                              \
    SHARED T##3 tx_load_##T##3(TextureContext * tx, int at)                                        \
    {                                                                                              \
        return TX_NEW(T##3, tx_load_##T(tx, at), tx_load_##T(tx, at + 1),                          \
                      tx_load_##T(tx, at + 2));                                                    \
    }                                                                                              \
    SHARED T##4 tx_load_##T##4(TextureContext * tx, int at)                                        \
    {                                                                                              \
        return TX_NEW(T##4, tx_load_##T(tx, at), tx_load_##T(tx, at + 1), tx_load_##T(tx, at + 2), \
                      tx_load_##T(tx, at + 3));                                                    \
    }
TX_LOADS(float)
TX_LOADS(int)
TX_LOADS(uint)

// What another node gave where `is_node`, else the constant: both are read and one is taken,
// because a conditional read keeps a loop over paths scalar.
SHARED float tx_either_float(int is_node, float4 v, float c) { return is_node ? v.x : c; }
SHARED float2 tx_either_float2(int is_node, float4 v, float2 c)
{
    return TX_NEW(float2, is_node ? v.x : c.x, is_node ? v.y : c.y);
}
SHARED float3 tx_either_float3(int is_node, float4 v, float3 c)
{
    return TX_NEW(float3, is_node ? v.x : c.x, is_node ? v.y : c.y, is_node ? v.z : c.z);
}
SHARED float4 tx_either_float4(int is_node, float4 v, float4 c)
{
    return TX_NEW(float4, is_node ? v.x : c.x, is_node ? v.y : c.y, is_node ? v.z : c.z,
                  is_node ? v.w : c.w);
}

// Argument k.
#define TX_ARGUMENT_OF_NODE(T)                                                 \
    SHARED T tx_argument_##T(TextureContext* tx, int region, int k)            \
    {                                                                          \
        const int source = (int)tx_word(tx, region + 4 * k);                   \
        const float4 result = tx_stack(tx, source < 0 ? 0 : source);           \
        const T value = tx_load_##T(tx, (int)tx_word(tx, region + 4 * k + 1)); \
        return tx_either_##T(source >= 0, result, value);                      \
    }
#define TX_ARGUMENT(T)                                                \
    SHARED T tx_argument_##T(TextureContext* tx, int region, int k)   \
    {                                                                 \
        return tx_load_##T(tx, (int)tx_word(tx, region + 4 * k + 1)); \
    }
TX_ARGUMENT_OF_NODE(float)
TX_ARGUMENT_OF_NODE(float2)
TX_ARGUMENT_OF_NODE(float3)
TX_ARGUMENT_OF_NODE(float4)
TX_ARGUMENT(int)
TX_ARGUMENT(int2)
TX_ARGUMENT(int3)
TX_ARGUMENT(int4)
TX_ARGUMENT(uint)
TX_ARGUMENT(uint2)
TX_ARGUMENT(uint3)
TX_ARGUMENT(uint4)
TX_ARGUMENT(sam2D)

// An array that a function is given: the caller's own, a constant table, or an argument. Elements
// of three words take four.
#define TX_VIEW(T, stride)                                                         \
    typedef struct {                                                               \
        const T* own;                                                              \
        TX_TABLE(T) table;                                                         \
        int word;                                                                  \
        int length;                                                                \
    } tx_view_##T;                                                                 \
    SHARED tx_view_##T tx_view_of_local_##T(const T* own, int length)              \
    {                                                                              \
        tx_view_##T v;                                                             \
        v.own = own;                                                               \
        v.table = 0;                                                               \
        v.word = 0;                                                                \
        v.length = length;                                                         \
        return v;                                                                  \
    }                                                                              \
    SHARED tx_view_##T tx_view_of_table_##T(TX_TABLE(T) table, int length)         \
    {                                                                              \
        tx_view_##T v;                                                             \
        v.own = 0;                                                                 \
        v.table = table;                                                           \
        v.word = 0;                                                                \
        v.length = length;                                                         \
        return v;                                                                  \
    }                                                                              \
    SHARED tx_view_##T tx_argument_view_##T(TextureContext* tx, int region, int k) \
    {                                                                              \
        tx_view_##T v;                                                             \
        v.own = 0;                                                                 \
        v.table = 0;                                                               \
        v.word = (int)tx_word(tx, region + 4 * k + 1);                             \
        v.length = (int)tx_word(tx, region + 4 * k + 2);                           \
        return v;                                                                  \
    }                                                                              \
    SHARED T tx_at_##T(TextureContext* tx, tx_view_##T v, int i)                   \
    {                                                                              \
        const int k = tx_index(tx, i, v.length);                                   \
        if (v.own) return v.own[k];                                                \
        if (v.table) return v.table[k];                                            \
        return tx_load_##T(tx, v.word + stride * k);                               \
    }
TX_VIEW(float, 1)
TX_VIEW(float2, 2)
TX_VIEW(float3, 4)
TX_VIEW(float4, 4)
TX_VIEW(int, 1)
TX_VIEW(int2, 2)
TX_VIEW(int3, 4)
TX_VIEW(int4, 4)
TX_VIEW(uint, 1)
TX_VIEW(uint2, 2)
TX_VIEW(uint3, 4)
TX_VIEW(uint4, 4)
TX_VIEW(sam2D, 1)

// What an entry returns, as the colour that a material reads.
SHARED float4 tx_result_of_float(float v) { return TX_NEW(float4, v, v, v, 1.0f); }
SHARED float4 tx_result_of_float2(float2 v) { return TX_NEW(float4, v.x, v.y, 0.0f, 1.0f); }
SHARED float4 tx_result_of_float3(float3 v) { return TX_NEW(float4, v.x, v.y, v.z, 1.0f); }
SHARED float4 tx_result_of_float4(float4 v) { return v; }
