// Hits of a pixel on procedural textures, kept in a file with what a device made of them, and run
// again on the host.
#pragma once

#include "backends/textures/texture_replay.hpp"
#include "host/commands/scene_flags.hpp"
#include "host/render/render.hpp"

namespace diptych {

// What a node gave that a material reads.
struct CapturedResult {
    std::string node;
    std::array<double, 4> value{};
};
struct CapturedHit {
    TextureHit hit;
    std::vector<CapturedResult> results;
};
struct TextureCapture {
    SceneFlags scene;  // its name and what its textures are; nothing else
    std::string scene_sha256;
    std::string backend, device;
    Settings settings{};  // camera, size, seed and samples alone
    std::vector<CapturedHit> hits;
};

// Traces the pixel's samples on the backend, which has the scene; the first hits, as many as fit
// into a file of some megabytes. Throws when there is none.
TextureCapture capture_textures(Backend& backend, const SceneData& scene, const SceneFlags& flags,
                                const std::string& name, const Pixel& pixel);

void write_capture(const std::string& path, const TextureCapture& capture);

// Throws std::runtime_error: not a capture, of another version, or damaged.
TextureCapture read_capture(const std::string& path);

// The capture's scene, or the one that the flags name. Throws when it is not what was captured.
SceneData load_for_replay(const TextureCapture& capture, SceneFlags flags, const std::string& path);

// Runs and prints every hit. 0: all results have the device's bits, 1: some have not.
int print_replay(const TextureCapture& capture, SceneData& scene, const std::string& path,
                 const GeneratedFolders& generated);

}  // namespace diptych
