#include "host/commands/texture_memory.hpp"

#include "common/textures/procedural.h"
#include "host/commands/texture_fault_report.hpp"
#include "host/image/whole_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <iostream>

namespace diptych {
namespace {

using nlohmann::json;

constexpr int page_words = int(sizeof(Material) / sizeof(uint));

class Memory {
public:
    explicit Memory(const SceneData& scene)
        : scene_(scene), words_(reinterpret_cast<const uint*>(scene.materials.data()))
    {
    }

    json region(const TextureAttachment& attachment) const
    {
        const TextureFunction& function = scene_.textures.functions.at(size_t(attachment.function));
        json arguments = json::array();
        int at = attachment.first_word;
        for (const TextureArgument& argument : function.arguments) {
            arguments.push_back(this->argument(argument, at));
            at += TEXTURE_DESCRIPTOR_WORDS;
        }
        return {{"word", attachment.first_word},
                {"page", attachment.first_word / page_words},
                {"pages", attachment.words / page_words},
                {"node", attachment.node},
                {"material", material_name(attachment.material)},
                {"file", function.file},
                {"function", function.entry},
                {"arguments", arguments}};
    }

    json program(int material, int first) const
    {
        json steps = json::array();
        for (int k = 0; k < word(first); ++k) {
            const int at = first + TEXTURE_PROGRAM_WORDS + k * TEXTURE_STEP_WORDS;
            const auto attachment = std::ranges::find(scene_.textures.attachments, word(at + 1),
                                                      &TextureAttachment::first_word);
            steps.push_back({{"word", at},
                             {"node", attachment->node},
                             {"function", word(at)},
                             {"region", word(at + 1)},
                             {"stack_slot", word(at + 2)},
                             {"results", word(at + 3)},
                             {"first_occlusion", word(at + 4)}});
        }
        const int requests = word(first + 3);
        return {
            {"word", first},
            {"page", first / page_words},
            {"material", material_name(material)},
            {"group", word(first + 1)},
            {"occlusion_requests", requests},
            {"words", TEXTURE_PROGRAM_WORDS + word(first) * TEXTURE_STEP_WORDS + requests * 5 + 1},
            {"steps", steps}};
    }

    std::string material_name(int material) const
    {
        return material < 0 ? "all" : scene_.material_names.at(size_t(material));
    }

private:
    int word(int at) const { return int(words_[at]); }

    json argument(const TextureArgument& argument, int at) const
    {
        json entry = {{"word", at}, {"name", argument.name}, {"type", type_of(argument)}};
        if (word(at) >= 0) {
            entry["stack_slot"] = word(at);
            return entry;
        }
        entry["value_word"] = word(at + 1);
        entry["length"] = word(at + 2);
        json values = json::array();
        const int width = width_of(argument), stride = width == 3 ? 4 : width;
        for (int k = 0; k < std::min(word(at + 2), 8); ++k)
            for (int c = 0; c < width; ++c) {
                const uint value = words_[word(at + 1) + k * stride + c];
                if (argument.type.starts_with("float"))
                    values.push_back(std::bit_cast<float>(value));
                else if (argument.type.starts_with("uint"))
                    values.push_back(value);
                else
                    values.push_back(int(value));
            }
        entry["values"] = values;  // the first elements
        return entry;
    }

    const SceneData& scene_;
    const uint* words_;
};

std::string value_text(const json& argument)
{
    if (argument.contains("stack_slot"))
        return fmt::format("from stack slot {}", argument["stack_slot"].get<int>());
    const bool is_more = argument["length"].get<int>() > 8;
    return fmt::format("at word {}: {}{}", argument["value_word"].get<int>(),
                       argument["values"].dump(), is_more ? " ..." : "");
}

void print(const json& memory)
{
    fmt::print("{} pages of {} words ({} bytes); {} materials, {} regions of arguments, {} "
               "programs; stack of {} slots\n",
               memory["pages"].get<int>(), page_words, sizeof(Material), memory["materials"].size(),
               memory["regions"].size(), memory["programs"].size(), memory["slots"].get<int>());
    for (const json& material : memory["materials"]) {
        fmt::print("page {:<5} material {}", material["page"].get<int>(),
                   material["name"].get<std::string>());
        if (material.contains("program_page"))
            fmt::print(": runs the program on page {}", material["program_page"].get<int>());
        fmt::print("\n");
        for (const json& region : material["regions"])
            fmt::print("           region on page {}\n", region.get<int>() / page_words);
    }
    for (const json& region : memory["regions"]) {
        fmt::print("page {:<5} arguments of node {} on {}: {} in {}, {} pages\n",
                   region["page"].get<int>(), region["node"].get<std::string>(),
                   region["material"].get<std::string>(), region["function"].get<std::string>(),
                   region["file"].get<std::string>(), region["pages"].get<int>());
        for (const json& argument : region["arguments"])
            fmt::print("           word {:<7} {:<9} {:<14} {}\n", argument["word"].get<int>(),
                       argument["type"].get<std::string>(), argument["name"].get<std::string>(),
                       value_text(argument));
    }
    for (const json& program : memory["programs"]) {
        fmt::print("page {:<5} program of {}, group {}: {} words, {} occlusion requests\n",
                   program["page"].get<int>(), program["material"].get<std::string>(),
                   program["group"].get<int>(), program["words"].get<int>(),
                   program["occlusion_requests"].get<int>());
        for (const json& step : program["steps"])
            fmt::print("           word {:<7} run node {} (function {}) with the region on page "
                       "{}{}{}\n",
                       step["word"].get<int>(), step["node"].get<std::string>(),
                       step["function"].get<int>(), step["region"].get<int>() / page_words,
                       step["stack_slot"].get<int>() < 0
                           ? ""
                           : fmt::format(", into stack slot {}", step["stack_slot"].get<int>()),
                       step["results"].get<int>() == 0
                           ? ""
                           : fmt::format(", results {:#x}", step["results"].get<int>()));
    }
}

}  // namespace

json texture_memory(const SceneData& scene)
{
    const Memory memory(scene);
    json materials = json::array(), regions = json::array(), programs = json::array();
    const int count = scene.textures.first_page;
    std::vector<json> of_material(size_t(count), json::array());
    for (const TextureAttachment& attachment : scene.textures.attachments) {
        regions.push_back(memory.region(attachment));
        if (attachment.material >= 0)
            of_material.at(size_t(attachment.material)).push_back(attachment.first_word);
    }
    for (int m = 0; m < count; ++m) {
        json entry = {
            {"page", m}, {"name", memory.material_name(m)}, {"regions", of_material[size_t(m)]}};
        const int* own = scene.materials[size_t(m)].texture_program;
        if (const int program = own[PROGRAM_SURFACE]) entry["program_page"] = program / page_words;
        for (const int which :
             {PROGRAM_SURFACE, PROGRAM_ALPHA, PROGRAM_EMISSION, PROGRAM_DISTANCE}) {
            const bool is_shared = which != PROGRAM_SURFACE && own[which] == own[PROGRAM_SURFACE];
            if (own[which] != 0 && !is_shared) programs.push_back(memory.program(m, own[which]));
        }
        materials.push_back(entry);
    }
    return {{"pages", scene.materials.size()},
            {"page_words", page_words},
            {"slots", scene.textures.slots},
            {"materials", materials},
            {"regions", regions},
            {"programs", programs}};
}

int show_texture_memory(const SceneFlags& flags, const std::string& file)
{
    if (flags.scene.empty())
        throw std::runtime_error("texture memory: no scene; name one with procedural textures");
    const SceneData scene = load_from_flags(flags);
    const json memory = texture_memory(scene);
    if (file == "-") {
        std::cout << memory.dump(2) << "\n" << std::flush;
        return 0;
    }
    if (!file.empty()) image::write_text(file, memory.dump(2) + "\n");
    print(memory);
    return 0;
}

}  // namespace diptych
