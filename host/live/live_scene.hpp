// A scene that stays loaded while people edit its files and type values: it finds out how much of
// itself an edit changes, and changes no more than that.
#pragma once

#include "host/scene/load.hpp"
#include "host/scene/texture_arguments.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace diptych {

// What has to follow on a device.
enum class EditKind {
    nothing,
    arguments,  // Backend::update_materials
    textures,   // Backend::update_textures, then update_materials
    scene       // everything: the scene was loaded anew
};

struct Edit {
    EditKind kind = EditKind::nothing;
    std::string what;  // for people, one line
    std::vector<std::string> warnings;
};

class LiveScene {
public:
    // Loads the scene with these LoadOptions::typed_values.
    using Loader = std::function<SceneData(const std::vector<std::string>& typed)>;

    // `file`: the scene's. `more`: files beside those that it names, as an environment picture.
    // `values`: those of the command line, which `load` knows. Throws what `load` throws.
    LiveScene(std::filesystem::path file, std::vector<std::filesystem::path> more,
              std::vector<std::string> values, Loader load);

    SceneData& data() { return *data_; }
    const SceneData& data() const { return *data_; }
    // All that the scene was read from, and what it named when it last could not be read.
    std::vector<std::filesystem::path> files() const;
    // Before they were last read: what was saved since may not be in data().
    std::filesystem::file_time_type read_at() const { return read_at_; }

    // After an edit of some of files(), or of a value. Each throws std::runtime_error with messages
    // for the user, and then nothing has changed. What an edit leaves, is final with accept();
    // until then undo() takes it back, and data() of before stays where it was.
    Edit look_again(const std::vector<std::filesystem::path>& changed);
    Edit set_value(const std::string& text);
    // Typed values of arguments that data() does not have: they are kept for a save that brings
    // them.
    std::vector<std::string> waiting() const;
    // accept() gives the scene of before where all of it was loaded anew: whoever uses it may go
    // on.
    std::unique_ptr<SceneData> accept();
    void undo();

private:
    // What the scene's file says, its nodes' arguments apart.
    struct Text {
        nlohmann::json rest;
        std::vector<nlohmann::json> arguments;  // by node
        size_t binary = 0;                      // digest of a .glb file's data
        std::vector<std::filesystem::path> files;
    };
    // What undo() needs.
    struct Before {
        Text text;
        std::vector<std::string> typed;
        std::unique_ptr<SceneData> data;  // when all of it was loaded anew
        SceneTextures textures;
        std::vector<std::pair<size_t, uint>> words;
    };

    template<class Change>
    Edit attempt(Change change);
    static Text read_text(const std::filesystem::path& file);
    Edit reload(const std::string& why);
    bool is_taken(const std::string& text) const;
    void drop_waiting(Edit& edit);
    std::string wait_for_file(const TextureNodeValues& node, const TextureValue& set,
                              const std::string& text);
    bool translate_again(const std::vector<std::filesystem::path>& changed, Edit& edit,
                         std::string& reason);
    bool update_values(Edit& edit, std::string& reason);
    nlohmann::json values_of(size_t node) const;
    bool write_value(size_t node, const std::string& name, const nlohmann::json& value,
                     std::string& reason);
    bool is_texture(const std::filesystem::path& file) const;

    std::filesystem::file_time_type read_at_ = std::filesystem::file_time_type::clock::now();
    std::filesystem::path file_;
    std::vector<std::filesystem::path> more_;
    std::vector<std::string> values_;
    std::vector<std::string> typed_;
    Loader load_;
    Text text_;
    std::vector<std::filesystem::path> attempted_;
    bool has_failed_ = false;  // the last look: the file on the disk may differ from text_
    std::unique_ptr<SceneData> data_;
    Before before_;
};

}  // namespace diptych
