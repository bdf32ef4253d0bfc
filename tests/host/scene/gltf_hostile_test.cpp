// Files that are broken or made to do harm: every one is refused with one line that says where,
// what and what to do, or loads as far as it is sound.
#include "host/scene/load.hpp"

#include "tests/host/scene/gltf_text.hpp"

#include <functional>
#include <limits>
#include <random>

namespace diptych {
namespace {

std::string refusal(const std::filesystem::path& file, const LoadOptions& options = {})
{
    try {
        load_scene(file, options);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "(loaded)";
}

void expect_refusal(const std::string& message, const std::string& part)
{
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find(": "), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message << ": says what to do";
}

// A triangle with one thing changed.
void expect_refused(const std::function<void(GltfText&)>& change, const std::string& part)
{
    GltfText gltf;
    gltf.add_triangle();
    change(gltf);
    expect_refusal(refusal(gltf.write()), part);
}

TEST(Hostile, Files_that_are_none)
{
    expect_refusal(refusal("/no/such/scene.gltf"), "scene.gltf: file: no such file");
    expect_refusal(refusal(test_folder()), "is a folder");
    expect_refusal(refusal("/dev/null"), "is not a regular file");
    expect_refusal(refusal(write_file("empty.glb", "")), "is empty");
    expect_refusal(refusal(write_file("blank.gltf", "  \n ")), "neither JSON nor a .glb");
    expect_refusal(refusal(write_file("magic.glb", "glTX12345678901234567890")),
                   "neither JSON nor a .glb");
    expect_refusal(refusal(write_file("cut.gltf", "{\"asset\": {")), "JSON: ");
    expect_refusal(refusal(write_file("list.gltf", "{}")), "asset: is missing");
    expect_refusal(refusal(write_file("bytes.gltf", "{\"asset\": \"\xff\xfe\"}")), "JSON: ");
}

TEST(Hostile, Json_nested_without_end)
{
    const std::string deep(2000000, '[');
    expect_refusal(refusal(write_file("deep.gltf", "{\"asset\":" + deep)), "JSON: ");
    const std::string closed = std::string(500000, '[') + std::string(500000, ']');
    GltfText gltf;
    gltf.add_triangle();
    std::string text = gltf.text();
    text.insert(1, "\"extras\": " + closed + ",");
    EXPECT_EQ(refusal(write_file("extras.gltf", text)), "(loaded)");
}

TEST(Hostile, Containers_with_wrong_lengths)
{
    const auto word = [](unsigned v) { return std::string(reinterpret_cast<const char*>(&v), 4); };
    const std::string json = "{\"asset\":{\"version\":\"2.0\"}} ";
    const auto glb = [&](unsigned version, unsigned total, unsigned chunk) {
        return write_file("a.glb",
                          "glTF" + word(version) + word(total) + word(chunk) + "JSON" + json);
    };
    const unsigned size = unsigned(json.size());
    EXPECT_EQ(refusal(glb(2, 20 + size, size)), "(loaded)");
    expect_refusal(refusal(glb(1, 20 + size, size)), "version 1");
    expect_refusal(refusal(glb(2, 21 + size, size)), "truncated");
    expect_refusal(refusal(glb(2, 20 + size, size + 1)), "truncated");
    expect_refusal(refusal(glb(2, 20 + size, 0xffffffffu)), "truncated");
    expect_refusal(refusal(write_file("b.glb", "glTF" + word(2))), "truncated");
}

TEST(Hostile, Indices_and_sizes_out_of_range)
{
    expect_refused([](GltfText& g) { g.document["nodes"][0]["mesh"] = 1; },
                   "nodes[0].mesh: names 1 of 1 meshes");
    expect_refused([](GltfText& g) { g.document["nodes"][0]["mesh"] = -1; },
                   "must be a whole number");
    expect_refused([](GltfText& g) { g.document["nodes"][0]["mesh"] = "0"; },
                   "must be a whole number");
    expect_refused([](GltfText& g) { g.document["nodes"][0]["mesh"] = 1e300; }, "must be a whole");
    expect_refused([](GltfText& g) { g.document["accessors"][0]["count"] = 4; },
                   "end at byte 48 of buffer view 0, which has 36 bytes");
    expect_refused([](GltfText& g) { g.document["accessors"][0]["count"] = 9000000000000000ull; },
                   "elements of 12 bytes end at byte");
    expect_refused([](GltfText& g) { g.document["accessors"][0]["byteOffset"] = 4; },
                   "end at byte 40");
    expect_refused([](GltfText& g) { g.document["bufferViews"][0]["byteLength"] = 40; },
                   "ends at byte 40 of buffer 0, which has 36");
    expect_refused([](GltfText& g) { g.document["bufferViews"][0]["byteStride"] = 8; },
                   "longer than the byteStride");
    expect_refused([](GltfText& g) { g.document["accessors"][0]["componentType"] = 5124; },
                   "5124 is not a type");
    expect_refused([](GltfText& g) { g.document["accessors"][0]["type"] = "VEC5"; },
                   "must be SCALAR");
    expect_refused([](GltfText& g) { g.document["accessors"][0]["type"] = "VEC2"; },
                   "has 2 components an element, where 3 belong");
    expect_refused([](GltfText& g) { g.document["meshes"][0]["primitives"][0]["mode"] = 7; },
                   "7 is not a mode");
    expect_refused(
        [](GltfText& g) {
            g.document["meshes"][0]["primitives"][0]["indices"] =
                g.add_accessor(std::vector<std::uint16_t>{0, 1, 3}, "SCALAR", 5123, 3);
        },
        "element 2 names vertex 3 of 3");
    expect_refused(
        [](GltfText& g) {
            g.document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
                g.add_accessor(std::vector<float>(6, 1.0f), "VEC3", 5126, 2);
        },
        "NORMAL: 2 elements for 3 vertices");
}

// Counts that promise more than the file holds must not be believed before anything is allocated.
TEST(Hostile, Huge_counts_allocate_nothing)
{
    expect_refused(
        [](GltfText& g) {
            g.document["accessors"][0].erase("bufferView");
            g.document["accessors"][0]["count"] = 4000000000000ull;
        },
        "4000000000000 elements without data");
    GltfText gltf;
    gltf.add_triangle();
    nlohmann::json document = nlohmann::json::parse(gltf.text());
    document["buffers"][0]["byteLength"] = 8000000000000000ull;
    document["bufferViews"][0]["byteLength"] = 8000000000000000ull;
    document["accessors"][0]["count"] = 600000000000000ull;
    expect_refusal(refusal(write_file("claims.gltf", document.dump())),
                   "8000000000000000 bytes announced, 36 there");
}

TEST(Hostile, Sparse_accessors)
{
    const auto sparse = [](int count, const std::vector<std::uint16_t>& indices) {
        return [=](GltfText& g) {
            const int where = g.add_view(indices);
            const int values = g.add_view(std::vector<float>(12, 1.0f));
            g.document["accessors"][0]["sparse"] = {
                {"count", count},
                {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                {"values", {{"bufferView", values}}}};
        };
    };
    expect_refused(sparse(1, {3}), "sparse index 0 names element 3 of 3");
    expect_refused(sparse(4, {0, 1, 2, 2}), "more than the accessor's own count");
    expect_refused(sparse(3, {0, 1}), "sparse.indices: 3 elements of 2 bytes end at byte 6");
}

TEST(Hostile, Positions_that_are_no_numbers)
{
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfText gltf;
        gltf.add_triangle({0, 0, 0, 1, bad, 0, 0, 1, 0});
        expect_refusal(refusal(gltf.write()),
                       "accessors[0] (meshes[0].primitives[0], POSITION): element 1 is not finite");
    }
}

TEST(Hostile, Cyclic_nodes)
{
    expect_refused([](GltfText& g) { g.document["nodes"][0]["children"] = {0}; },
                   "nodes[0]: is its own descendant");
    expect_refused(
        [](GltfText& g) {
            g.document["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}};
        },
        "remove the cycle");
}

// Each node has the next as a child twice: 2^60 paths lead to the last.
TEST(Hostile, Nodes_of_many_parents_do_not_explode)
{
    GltfText gltf;
    gltf.add_triangle();
    for (int k = 0; k < 60; ++k) {
        gltf.document["nodes"].push_back({{"children", {k, k}}});
    }
    gltf.document["scenes"][0]["nodes"] = {60};
    EXPECT_EQ(refusal(gltf.write()), "(loaded)");
}

TEST(Hostile, Transforms_beyond_numbers)
{
    expect_refused(
        [](GltfText& g) {
            g.document["nodes"].push_back({{"children", {0}}, {"scale", {1e200, 1, 1}}});
            g.document["nodes"].push_back({{"children", {1}}, {"scale", {1e200, 1, 1}}});
            g.document["scenes"][0]["nodes"] = {2};
        },
        "beyond the range of numbers");
    expect_refused(
        [](GltfText& g) {
            g.document["nodes"][0]["scale"] = {1e60, 1, 1};
        },
        "beyond the range of float");
    expect_refused(
        [](GltfText& g) {
            g.document["nodes"][0]["scale"] = {1, 1};
        },
        "must be 3 numbers");
}

TEST(Hostile, Uris_may_not_leave_the_folder)
{
    write_file("outside.bin", std::string(36, '\0'));
    for (const char* uri : {"../outside.bin", "%2e%2e/outside.bin", "..%5Coutside.bin",
                            "sub/../../outside.bin", "/etc/passwd", "file:///etc/passwd"}) {
        GltfText gltf;
        gltf.add_triangle();
        gltf.document["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
        gltf.bytes.clear();
        const auto file = write_file("inside/scene.gltf", gltf.text());
        expect_refusal(refusal(file), "leaves the scene's folder; pass --allow-outside");
        if (std::string(uri).find("outside") != std::string::npos &&
            std::string(uri).find("sub/") == std::string::npos) {
            EXPECT_EQ(refusal(file, {.allow_outside = true}), "(loaded)") << uri;
        }
    }
}

TEST(Hostile, Uris_may_not_leave_the_folder_through_links)
{
    const auto target = write_file("secret.bin", std::string(36, '\0'));
    GltfText gltf;
    gltf.add_triangle();
    gltf.document["buffers"] = {{{"byteLength", 36}, {"uri", "link.bin"}}};
    gltf.bytes.clear();
    const auto file = write_file("inside/scene.gltf", gltf.text());
    std::filesystem::create_symlink(target, file.parent_path() / "link.bin");
    expect_refusal(refusal(file), "leaves the scene's folder");
}

TEST(Hostile, Buffers_that_are_not_there)
{
    const auto with_uri = [](const char* uri) {
        return [=](GltfText& g) {
            g.document["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
            g.bytes.clear();
        };
    };
    expect_refused(with_uri("missing.bin"), "buffers[0] (missing.bin): no such file");
    expect_refused(with_uri("http://host/a.bin"), "is not in the file system");
    expect_refused(with_uri("data:x;base64,@@@@"), "is not base64");
    expect_refused(with_uri("data:x"), "has no comma");
    expect_refused(with_uri("data:x;base64,AAAA"), "36 bytes announced, 3 there");
    expect_refused(with_uri("."), "is a folder");
    expect_refused(with_uri("a%00b"), "names no file");
    expect_refused(
        [](GltfText& g) {
            g.document["buffers"] = {{{"byteLength", 36}}};
            g.bytes.clear();
        },
        "has no data");
}

void use_image(GltfText& g, const nlohmann::json& image)
{
    g.document["images"] = {image};
    g.document["textures"] = {{{"source", 0}}};
    g.document["materials"] = {
        {{"name", "wood"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    g.document["meshes"][0]["primitives"][0]["material"] = 0;
}

TEST(Hostile, Images_that_cannot_be_read_name_file_and_material)
{
    expect_refused(
        [](GltfText& g) {
            use_image(g, {{"uri", "no.png"}});
        },
        "images[0] (no.png), of material \"wood\": no such file");
    expect_refused(
        [](GltfText& g) {
            write_file("text.png", "this is no image");
            use_image(g, {{"uri", "text.png"}});
        },
        "images[0] (text.png), of material \"wood\": its first bytes are of no image format");
    expect_refused(
        [](GltfText& g) {
            write_file("cut.png", "\x89PNG\r\n\x1a\n");
            use_image(g, {{"uri", "cut.png"}});
        },
        "images[0] (cut.png), of material \"wood\": an image of 0 x 0 pixels");
    expect_refused([](GltfText& g) { use_image(g, nlohmann::json::object()); },
                   "has neither a URI nor a buffer view");
    expect_refused(
        [](GltfText& g) {
            use_image(g, {{"uri", "x.ktx2"}});
            g.document["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
        },
        "has only a KTX2 image");
    // Broken, but nothing that is shown uses it.
    GltfText gltf;
    gltf.add_triangle();
    use_image(gltf, {{"uri", "no.png"}});
    gltf.document["meshes"][0]["primitives"][0].erase("material");
    EXPECT_EQ(refusal(gltf.write()), "(loaded)");
}

TEST(Hostile, Required_extensions_that_are_unknown)
{
    expect_refused(
        [](GltfText& g) { g.document["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
        "KHR_draco_mesh_compression is not supported");
}

TEST(Hostile, Pictures_of_no_size)
{
    GltfText gltf;
    gltf.add_triangle();
    const auto file = gltf.write();
    LoadOptions options;
    options.width = 0;
    expect_refusal(refusal(file, options), "picture: 0 x 512 pixels");
    options = {};
    options.has_view = true;
    expect_refusal(refusal(file, options), "the eye is at the target");
    options.target[2] = -1;
    options.fov = 4;
    expect_refusal(refusal(file, options), "field of view");
}

// Bytes and numbers changed at random: never a crash, never more than one line.
TEST(Hostile, Random_damage)
{
    GltfText gltf;
    auto& primitive = gltf.add_triangle({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    primitive["indices"] =
        gltf.add_accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR", 5123, 6);
    gltf.document["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    gltf.document["nodes"].push_back(
        {{"camera", 0},
         {"children", {0}},
         {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}});
    gltf.document["scenes"][0]["nodes"] = {1};
    const std::string text = gltf.text();
    std::mt19937 random(20240101);
    int loaded = 0;
    constexpr int rounds = 2000;
    LoadOptions options;
    options.environment = "none";
    for (int round = 0; round < rounds; ++round) {
        std::string damaged = text;
        for (int k = 0; k <= round % 4; ++k) {
            const size_t at = random() % damaged.size();
            switch (random() % 3) {
            case 0:
                damaged[at] = char(random() % 256);
                break;
            case 1:
                damaged.erase(at, 1 + random() % 8);
                break;
            default:
                damaged.insert(at, std::to_string(random() >> random() % 32));
            }
        }
        const std::string message = refusal(write_file("damaged.gltf", damaged), options);
        loaded += message == "(loaded)";
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    EXPECT_GT(loaded, rounds / 50);
    EXPECT_LT(loaded, rounds / 2);
}

}  // namespace
}  // namespace diptych
