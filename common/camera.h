// Rays from the camera through a point of the picture.
#pragma once

#include "platform.h"

#include "common/buffers.h"
#include "common/effects.h"
#include "common/math.h"

typedef struct {
    float3 origin;
    float3 direction;  // unit length
} Ray;

// x and y in pixels from the upper left corner of the picture.
SHARED Ray camera_ray(const Scene* scene, float x, float y)
{
    const float across = 2.0f * x / (float)scene->settings[0].width - 1.0f;
    const float upward = 1.0f - 2.0f * y / (float)scene->settings[0].height;
    const float3 right = xyz(scene->settings[0].camera_right) * across;
    const float3 up = xyz(scene->settings[0].camera_up) * upward;
    const float3 forward = xyz(scene->settings[0].camera_forward);
    const float3 origin = xyz(scene->settings[0].camera_origin);
    Ray ray;
    ray.origin = origin;
    ray.direction = vec_normalize(forward + right + up);
    if (uses(scene, EFFECT_ORTHOGRAPHIC)) {
        // A vectorised loop may be compiled for more effects than the scene has.
        const int is_parallel = scene->settings[0].camera_kind == CAMERA_ORTHOGRAPHIC;
        const float3 shifted = origin + right + up;
        ray.origin =
            make_float3(is_parallel ? shifted.x : origin.x, is_parallel ? shifted.y : origin.y,
                        is_parallel ? shifted.z : origin.z);
        ray.direction = make_float3(is_parallel ? forward.x : ray.direction.x,
                                    is_parallel ? forward.y : ray.direction.y,
                                    is_parallel ? forward.z : ray.direction.z);
    }
    return ray;
}
