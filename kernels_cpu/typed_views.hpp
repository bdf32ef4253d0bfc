// A scene and its paths with their types, over the pointers that cross from one kernel set to
// another. Included in the unnamed namespace of whoever has the dialect's types, so that kernel
// sets never share its code.
#pragma once

inline Scene scene_from(const SceneView& view)
{
    Scene scene{};
    scene.effects = view.effects;
    int row = 0;
#define BIND_SCENE(type, name) scene.name = static_cast<decltype(scene.name)>(view.buffers[row++]);
    SCENE_BUFFERS(BIND_SCENE)
#undef BIND_SCENE
    return scene;
}

// What the view has no planes for stays null.
inline Paths paths_from(const PathView& view)
{
    Paths paths{};
    paths.capacity = view.capacity;
    paths.results = view.results;
    paths.samples = view.samples;
    paths.pixel_shift = view.pixel_shift;
    paths.turn = view.turn;
    paths.lookup = view.lookup;
    paths.items = static_cast<decltype(paths.items)>(view.items);
    int row = 0;
#define BIND_PLANE(planes, name) \
    if (view.planes) paths.name = static_cast<decltype(paths.name)>(view.planes[row++]);
#define BIND_PATH(type, name, life) BIND_PLANE(planes, name)
#define BIND_RESULT(type, name) BIND_PLANE(result_planes, name)
#define BIND_TEXTURE(type, name) BIND_PLANE(texture_planes, name)
#define BIND_TEXTURE_RESULT(type, name) BIND_PLANE(texture_result_planes, name)
    PATH_BUFFERS(BIND_PATH)
    row = 0;
    RESULT_BUFFERS(BIND_RESULT)
    row = 0;
    TEXTURE_BUFFERS(BIND_TEXTURE)
    row = 0;
    TEXTURE_RESULT_BUFFERS(BIND_TEXTURE_RESULT)
#undef BIND_TEXTURE_RESULT
#undef BIND_TEXTURE
#undef BIND_RESULT
#undef BIND_PATH
#undef BIND_PLANE
    return paths;
}
