// What choosing a point on a light gives back.
#pragma once

#include "platform.h"

typedef struct {
    float3 direction;  // unit length, towards the light
    float distance;    // FLOAT_MAX for lights at infinity
    float3 radiance;   // for punctual lights: irradiance on a surface that faces them
    float pdf;        // over solid angle, the choice of the light included; for punctual lights its
                      // probability alone
    int is_punctual;  // cannot be hit by chance
} LightSample;
