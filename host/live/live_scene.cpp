#include "host/live/live_scene.hpp"

#include "backends/textures/texture_tool.hpp"
#include "host/scene/gltf_document.hpp"
#include "host/scene/texture_graph.hpp"
#include "host/scene/uri.hpp"

#include "platform.h"

#include "common/textures/procedural.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <set>
#include <string_view>

namespace diptych {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* extension_name = "DIPTYCH_procedural_texture";

// Line and column of a byte.
std::pair<size_t, size_t> place_of(const std::string& text, size_t byte)
{
    const std::string_view before = std::string_view(text).substr(0, std::min(byte, text.size()));
    const size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    return {size_t(std::count(before.begin(), before.end(), '\n')) + 1, before.size() - line_start};
}

json parsed(const fs::path& file, const std::string& text)
{
    try {
        return json::parse(text);
    } catch (const json::parse_error& error) {
        const auto [line, column] = place_of(text, error.byte);
        std::string reason = error.what();
        if (const size_t at = reason.find(": "); at != std::string::npos)
            reason = reason.substr(at + 2);
        throw SceneError(fmt::format("{}:{}:{}: error: {}; repair the file", file.string(), line,
                                     std::max<size_t>(column, 1), printable(reason)));
    }
}

// Files beside the scene's that a list of its buffers or images names.
void add_files(const json& document, const char* list, const fs::path& folder,
               std::vector<fs::path>& files)
{
    const auto entries = document.find(list);
    if (entries == document.end() || !entries->is_array()) return;
    for (const json& entry : *entries) {
        if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
        const auto uri = entry["uri"].get<std::string>();
        if (is_data_uri(uri)) continue;
        const fs::path path = uri_path(uri, list);
        files.push_back(path.is_absolute() ? path : folder / path);
    }
}

bool is_same(const OcclusionRequest& a, const OcclusionRequest& b)
{
    return a.distance == b.distance && a.distance_argument == b.distance_argument &&
           a.hemisphere == b.hemisphere && a.is_same_object == b.is_same_object;
}

std::string takes_others(const TextureFunction& function)
{
    return fmt::format("{}: {} takes or asks for other things than before",
                       fs::path(function.file).filename().string(), function.entry);
}

// Whether all but the function's text is as it was.
bool takes_the_same(const TextureFunction& a, const TextureFunction& b)
{
    const auto same_argument = [](const TextureArgument& x, const TextureArgument& y) {
        return x.name == y.name && type_of(x) == type_of(y);
    };
    return a.entry == b.entry && a.attributes == b.attributes &&
           std::ranges::equal(a.arguments, b.arguments, same_argument) &&
           std::ranges::equal(a.occlusion, b.occlusion, is_same);
}

uint word_at(const SceneData& scene, size_t word)
{
    uint value = 0;
    std::memcpy(&value, reinterpret_cast<const char*>(scene.materials.data()) + 4 * word, 4);
    return value;
}

// Regions of the nodes that paint emitters: the power of these was estimated from what they gave.
std::set<int> regions_that_shine(const SceneData& scene)
{
    std::set<int> regions;
    for (size_t m = 0; m < size_t(scene.textures.first_page); ++m) {
        const size_t program = size_t(scene.materials[m].texture_program[PROGRAM_EMISSION]);
        if (program == 0) continue;
        for (size_t k = 0; k < word_at(scene, program); ++k)
            regions.insert(
                int(word_at(scene, program + TEXTURE_PROGRAM_WORDS + k * TEXTURE_STEP_WORDS + 1)));
    }
    return regions;
}

// Whether one of the attachments that `is_meant` picks paints emitters.
template<class IsMeant>
bool shines(const SceneData& scene, IsMeant is_meant)
{
    if ((scene.effects & EFFECT_PROCEDURAL_EMISSION) == 0) return false;
    const std::set<int> regions = regions_that_shine(scene);
    return std::ranges::any_of(
        scene.textures.attachments, [&](const TextureAttachment& attachment) {
            return is_meant(attachment) && regions.contains(attachment.first_word);
        });
}

// Adds a value in the place of an earlier one of the same argument.
void put(std::vector<std::string>& values, const TextureValue& set, const std::string& text)
{
    std::erase_if(values, [&](const std::string& old) {
        return old.starts_with(set.node + "." + set.argument + "=");
    });
    values.push_back(text);
}

void set_word(SceneData& scene, size_t word, uint value)
{
    std::memcpy(reinterpret_cast<char*>(scene.materials.data()) + 4 * word, &value, 4);
}

}  // namespace

LiveScene::LiveScene(fs::path file, std::vector<fs::path> more, std::vector<std::string> values,
                     Loader load)
    : file_(std::move(file)), more_(std::move(more)), values_(std::move(values)),
      load_(std::move(load)), text_(read_text(file_)),
      data_(std::make_unique<SceneData>(load_(typed_)))
{
}

LiveScene::Text LiveScene::read_text(const fs::path& file)
{
    GltfContainer container;
    try {
        container = open_gltf(file);
    } catch (const SceneError& error) {
        throw SceneError(printable(file.string()) + ": " + error.what());
    }
    Text text;
    text.binary = std::hash<std::string_view>{}(
        {reinterpret_cast<const char*>(container.binary.data()), container.binary.size()});
    text.rest = parsed(file, container.text);
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    add_files(text.rest, "buffers", folder, text.files);
    add_files(text.rest, "images", folder, text.files);
    if (!text.rest.is_object() || !text.rest.contains("extensions")) return text;
    const json::json_pointer at(std::string("/extensions/") + extension_name + "/nodes");
    if (!text.rest["extensions"].is_object() || !text.rest.contains(at) ||
        !text.rest[at].is_array())
        return text;
    for (json& node : text.rest[at]) {
        const bool has =
            node.is_object() && node.contains("arguments") && node["arguments"].is_object();
        text.arguments.push_back(has ? node["arguments"] : json::object());
        if (has) node.erase("arguments");
    }
    return text;
}

std::vector<fs::path> LiveScene::files() const
{
    std::set<fs::path> files = {file_};
    files.insert(more_.begin(), more_.end());
    files.insert(text_.files.begin(), text_.files.end());
    files.insert(attempted_.begin(), attempted_.end());
    for (const TextureFunction& function : data_->textures.functions) files.insert(function.file);
    return {files.begin(), files.end()};
}

bool LiveScene::is_texture(const fs::path& file) const
{
    return std::ranges::any_of(data_->textures.functions, [&](const TextureFunction& function) {
        return fs::path(function.file) == file;
    });
}

template<class Change>
Edit LiveScene::attempt(Change change)
{
    before_ = {text_, typed_, nullptr, data_->textures, {}};
    try {
        Edit edit = change();
        has_failed_ = false;
        attempted_.clear();
        return edit;
    } catch (...) {
        undo();
        has_failed_ = true;
        throw;
    }
}

Edit LiveScene::reload(const std::string& why)
{
    read_at_ = fs::file_time_type::clock::now();
    text_ = read_text(file_);
    attempted_ = text_.files;
    auto fresh = std::make_unique<SceneData>(load_(typed_));
    std::vector<std::string> news;
    std::ranges::copy_if(fresh->notices, std::back_inserter(news), [&](const std::string& line) {
        return std::ranges::find(data_->notices, line) == data_->notices.end();
    });
    before_.data = std::move(data_);
    data_ = std::move(fresh);
    Edit edit{EditKind::scene, why + ": the whole scene is loaded again", std::move(news)};
    drop_waiting(edit);
    return edit;
}

Edit LiveScene::look_again(const std::vector<fs::path>& changed)
{
    read_at_ = fs::file_time_type::clock::now();
    return attempt([&]() -> Edit {
        const auto other = std::ranges::find_if(
            changed, [&](const fs::path& file) { return file != file_ && !is_texture(file); });
        if (has_failed_ || std::ranges::find(changed, file_) != changed.end()) {
            Text text = read_text(file_);
            attempted_ = text.files;
            const bool is_more = text.rest != text_.rest || text.binary != text_.binary;
            text_ = std::move(text);
            if (is_more) return reload(file_.filename().string() + ": more than arguments changed");
        }
        if (other != changed.end()) return reload(other->filename().string());
        Edit edit;
        std::string reason;
        if (!translate_again(changed, edit, reason) || !update_values(edit, reason))
            return reload(reason);
        drop_waiting(edit);
        return edit;
    });
}

// False: what a function takes has changed, not its text alone.
bool LiveScene::translate_again(const std::vector<fs::path>& changed, Edit& edit,
                                std::string& reason)
{
    for (TextureFunction& function : data_->textures.functions) {
        const fs::path file = function.file;
        if (std::ranges::find(changed, file) == changed.end() && !has_failed_) continue;
        TextureFunction fresh =
            translate_texture({file, function.file, function.asked, function.id});
        fresh.asked = function.asked;
        if (!takes_the_same(function, fresh)) {
            reason = takes_others(fresh);
            return false;
        }
        const bool is_other = fresh.cpp != function.cpp || fresh.opencl != function.opencl;
        const int number = int(&function - data_->textures.functions.data());
        if (is_other && shines(*data_, [&](const auto& a) { return a.function == number; })) {
            reason = file.filename().string() + " paints light, whose share is estimated anew";
            return false;
        }
        if (is_other) {
            edit.kind = EditKind::textures;
            edit.what = file.filename().string();
            edit.warnings.insert(edit.warnings.end(), fresh.warnings.begin(), fresh.warnings.end());
        }
        function = std::move(fresh);
    }
    return true;
}

// What a node's arguments are to be: the file's, those of the command line and the keyboard, then
// the defaults of the texture.
json LiveScene::values_of(size_t k) const
{
    const TextureNodeValues& node = data_->textures.nodes[k];
    json values = k < text_.arguments.size() ? text_.arguments[k] : json::object();
    const auto put_in = [&](const std::string& text, bool is_typed) {
        const TextureValue set = parse_texture_value(text, "--set " + printable(text));
        if (set.node == node.name && (!is_typed || node.values.contains(set.argument)))
            values[set.argument] = set.value;
    };
    for (const std::string& text : values_) put_in(text, false);
    for (const std::string& text : typed_) put_in(text, true);
    for (const TextureArgument& argument :
         data_->textures.functions[size_t(node.function)].arguments) {
        if (values.contains(argument.name)) continue;
        if (auto value = default_of(argument)) values[argument.name] = std::move(*value);
    }
    return values;
}

// Brings every argument that is to have another value up to it. False: that takes more than bytes.
bool LiveScene::update_values(Edit& edit, std::string& reason)
{
    std::vector<std::string> changes;
    for (size_t k = 0; k < data_->textures.nodes.size(); ++k) {
        TextureNodeValues& node = data_->textures.nodes[k];
        const json values = values_of(k);
        for (const auto& [name, old] : node.values) {
            if (values.contains(name)) continue;
            throw SceneError(fmt::format("texture node {}: its argument {} is missing; give it a "
                                         "value",
                                         node.name, name));
        }
        for (const auto& [name, value] : values.items()) {
            const std::string text = dumped(value);
            const auto old = node.values.find(name);
            if (old != node.values.end() && old->second == text) continue;
            if (!write_value(k, name, value, reason)) return false;
            node.values[name] = text;
            changes.push_back(fmt::format("{}.{}={}", node.name, printable(name),
                                          text.size() > 60 ? text.substr(0, 57) + "..." : text));
        }
    }
    if (changes.empty()) return true;
    if (edit.kind == EditKind::nothing) edit.kind = EditKind::arguments;
    if (changes.size() > 4) changes = {fmt::format("{} values", changes.size())};
    edit.what += fmt::format("{}{}", edit.what.empty() ? "" : ", ", fmt::join(changes, ", "));
    return true;
}

bool LiveScene::write_value(size_t k, const std::string& name, const json& value,
                            std::string& reason)
{
    const TextureNodeValues& node = data_->textures.nodes[k];
    const TextureFunction& function = data_->textures.functions[size_t(node.function)];
    const std::string where =
        fmt::format("texture node {}: argument {}", node.name, printable(name));
    reason = fmt::format("{}.{} changes more than numbers", node.name, printable(name));
    const std::optional<std::vector<double>> numbers = constant_numbers(value, where);
    if (!numbers) return false;
    if (shines(*data_, [&](const auto& a) { return a.node_id == int(k); })) {
        reason = fmt::format("{}.{} paints light, whose share is estimated anew", node.name,
                             printable(name));
        return false;
    }
    check_argument({.name = node.name}, function, name, {.numbers = *numbers});
    const TextureArgument& argument = argument_named(name, {.name = node.name}, function);
    const std::vector<uint> words = constant_words(argument, *numbers);
    const size_t place = size_t(&argument - function.arguments.data());
    for (const TextureAttachment& attachment : data_->textures.attachments) {
        if (attachment.node_id != int(k)) continue;
        const size_t descriptor = size_t(attachment.first_word) + 4 * place;
        const size_t elements = words.size() / size_t(stride_of(argument));
        if (int(word_at(*data_, descriptor)) != -1 ||
            word_at(*data_, descriptor + 2) != uint(elements))
            return false;
        const size_t first = word_at(*data_, descriptor + 1);
        for (size_t w = 0; w < words.size(); ++w) {
            before_.words.emplace_back(first + w, word_at(*data_, first + w));
            set_word(*data_, first + w, words[w]);
        }
    }
    return true;
}

bool LiveScene::is_taken(const std::string& text) const
{
    const TextureValue set = parse_texture_value(text, printable(text));
    const auto& nodes = data_->textures.nodes;
    const auto node = std::ranges::find(nodes, set.node, &TextureNodeValues::name);
    return node != nodes.end() && node->values.contains(set.argument);
}

std::vector<std::string> LiveScene::waiting() const
{
    std::vector<std::string> waiting;
    std::ranges::copy_if(typed_, std::back_inserter(waiting),
                         [&](const std::string& text) { return !is_taken(text); });
    return waiting;
}

// Once all files are read and taken, nothing is left to wait for.
void LiveScene::drop_waiting(Edit& edit)
{
    for (const std::string& text : waiting()) {
        edit.warnings.push_back(printable(text) + ": no texture takes it now; dropped");
        std::erase(typed_, text);
    }
}

// An argument that at best the function's file as it is by now declares: its value waits until that
// file is taken. Returns what the file changes.
std::string LiveScene::wait_for_file(const TextureNodeValues& node, const TextureValue& set,
                                     const std::string& text)
{
    const TextureFunction& function = data_->textures.functions[size_t(node.function)];
    TextureFunction fresh;
    try {
        fresh = translate_texture({function.file, function.file, function.asked, function.id});
    } catch (const std::runtime_error&) {  // whether it takes the value, a better save will show
        put(typed_, set, text);
        throw;
    }
    const TextureNode named{.name = node.name};
    argument_named(set.argument, named, fresh);
    const std::string where =
        fmt::format("texture node {}: argument {}", node.name, printable(set.argument));
    if (const auto numbers = constant_numbers(set.value, where))
        check_argument(named, fresh, set.argument, {.numbers = *numbers});
    put(typed_, set, text);
    return takes_others(fresh);
}

Edit LiveScene::set_value(const std::string& text)
{
    const TextureValue set = parse_texture_value(text, printable(text));
    const auto& nodes = data_->textures.nodes;
    const TextureNodeValues& node =
        nodes[size_t(texture_node_named(set.node, nodes, printable(text)))];
    const bool is_new = !node.values.contains(set.argument);
    std::string reason = is_new ? wait_for_file(node, set, text) : "";
    const bool had_failed = has_failed_;
    try {
        Edit edit = attempt([&]() -> Edit {
            if (is_new) return reload(reason);
            put(typed_, set, text);
            Edit edit;
            return update_values(edit, reason) ? edit : reload(reason);
        });
        has_failed_ = had_failed && edit.kind != EditKind::scene;
        return edit;
    } catch (...) {
        has_failed_ = had_failed;
        throw;
    }
}

std::unique_ptr<SceneData> LiveScene::accept()
{
    std::unique_ptr<SceneData> old = std::move(before_.data);
    before_ = {};
    return old;
}

void LiveScene::undo()
{
    if (before_.data) {
        data_ = std::move(before_.data);
    }
    for (auto at = before_.words.rbegin(); at != before_.words.rend(); ++at)
        set_word(*data_, at->first, at->second);
    data_->textures = std::move(before_.textures);
    text_ = std::move(before_.text);
    typed_ = std::move(before_.typed);
    before_ = {};
    has_failed_ = true;
}

}  // namespace diptych
