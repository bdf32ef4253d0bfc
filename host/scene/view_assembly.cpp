// The scene's extent, and the camera that looks at it.
#include "host/scene/scene_assembly.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace diptych {
namespace {

float4 to_float4(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2]), 0}; }

}  // namespace

void SceneAssembly::assemble_bounds()
{
    Settings& settings = data_.settings[0];
    Vec3 low, high;
    settings.scene_radius = 1;
    if (data_.triangles.empty() || !builder_.bounds(low, high)) {
        return;
    }
    const Vec3 centre = (low + high) * 0.5;
    settings.scene_centre = to_float4(centre);
    // Rounded up: nothing may stick out of it.
    settings.scene_radius = float(length(high - centre) * (1 + 1e-6));
}

// Looks at the whole bounding sphere from the front, a little from the right and from above.
CameraInput SceneAssembly::framing_camera() const
{
    const Settings& settings = data_.settings[0];
    CameraInput camera;
    const Vec3 centre{settings.scene_centre.x, settings.scene_centre.y, settings.scene_centre.z};
    const double half_fov = camera.fov / 2;
    const double narrowest =
        std::min(half_fov, std::atan(std::tan(half_fov) * settings.width / settings.height));
    const double radius = std::max(double(settings.scene_radius), 1e-6);
    camera.target = centre;
    camera.eye = centre + unit({0.5, 0.35, 1}) * (radius / std::sin(narrowest));
    return camera;
}

void SceneAssembly::assemble_camera()
{
    Settings& settings = data_.settings[0];
    const CameraInput camera = builder_.camera_ ? *builder_.camera_ : framing_camera();
    const Vec3 forward = unit(camera.target - camera.eye);
    Vec3 right = unit(cross(forward, unit(camera.up)));
    if (!(length(forward) > 0.5)) {
        throw SceneError("camera: the eye is at the target; move one of them");
    }
    if (!(length(cross(forward, unit(camera.up))) > 1e-9)) {
        // Looking straight along `up`: any horizon will do.
        right = unit(cross(forward, std::abs(forward[2]) < 0.9 ? Vec3{0, 0, -1} : Vec3{1, 0, 0}));
    }
    const Vec3 up = cross(right, forward);
    const bool is_orthographic = camera.half_height > 0;
    const double half_height = is_orthographic ? camera.half_height : std::tan(camera.fov / 2);
    if (!is_orthographic && !(camera.fov > 0 && camera.fov < 3.1415)) {
        throw SceneError(fmt::format("camera: a vertical field of view of {:.4g} degrees; it must "
                                     "lie between 0 and 180",
                                     camera.fov * 57.29577951308232));
    }
    settings.camera_kind = is_orthographic ? CAMERA_ORTHOGRAPHIC : CAMERA_PERSPECTIVE;
    settings.camera_origin = to_float4(camera.eye);
    settings.camera_forward = to_float4(forward);
    settings.camera_right = to_float4(right * (half_height * settings.width / settings.height));
    settings.camera_up = to_float4(up * half_height);
}

}  // namespace diptych
