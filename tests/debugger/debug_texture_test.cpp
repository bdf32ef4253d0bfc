// `diptych debug`: a debugger stands in the texture's own file, sees its arguments and values, and
// they are those of the picture.
#include "tests/debugger/textured_scene.hpp"

#include "tests/host/commands/program.hpp"
#include "tests/textures/planted_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>

using namespace diptych;

namespace {

std::vector<std::string> with_view(std::vector<std::string> words)
{
    words.insert(words.end(), painted_view.begin(), painted_view.end());
    return words;
}

std::string why_no_debugger(const std::string& debugger)
{
    const Outcome version = run_program({debugger, "--version"});
    if (version.exit_code != 0) return debugger + " is not installed";
    const bool is_lldb = debugger == "lldb";
    const Outcome trial =
        is_lldb ? run_program({"lldb", "--batch", "-o", "run", "--", "/bin/true"})
                : run_program({"gdb", "-batch", "-nx", "-ex", "run", "--args", "true"});
    if (trial.text().find(is_lldb ? "exited with status = 0" : "exited normally") ==
        std::string::npos)
        return debugger + " may not trace programs here: " + trial.text();
    return "";
}

// Those that can be used here; why: of the others.
std::vector<std::string> debuggers(std::string& why)
{
    std::vector<std::string> usable;
    for (const std::string debugger : {"gdb", "lldb"}) {
        const std::string reason = why_no_debugger(debugger);
        if (reason.empty())
            usable.push_back(debugger);
        else
            why += reason + "; ";
    }
    return usable;
}

class DebugTexture : public testing::Test {
protected:
    void SetUp() override { write_painted_scene(folder_); }

    Outcome debug(std::vector<std::string> more, const std::vector<std::string>& commands = {})
    {
        std::vector<std::string> words = with_view({"debug", folder_ / "scene.gltf"});
        words.insert(words.end(), more.begin(), more.end());
        for (const std::string& command : commands)
            words.insert(words.end(), {"--execute", command});
        return run_diptych(words, options());
    }

    // What the picture shows of a node, to the bit.
    std::array<float, 3> solo(const std::string& node, const std::string& pixel,
                              const std::string& backend)
    {
        const Outcome outcome =
            run_diptych(with_view({"render", folder_ / "scene.gltf", "--solo", node, "--samples",
                                   "1", "--pixel", pixel, "--quiet", "--backend", backend}),
                        options());
        std::array<float, 3> value{};
        const size_t at = outcome.out.find(": ");
        EXPECT_TRUE(at != std::string::npos && std::sscanf(outcome.out.c_str() + at, ": %f %f %f",
                                                           &value[0], &value[1], &value[2]) == 3)
            << outcome.text();
        return value;
    }

    static std::array<float, 3> vector_after(const std::string& text, const std::string& words,
                                             char bracket = '{')
    {
        std::array<float, 3> value{};
        const size_t at = text.find(words);
        const std::string pattern = std::string(1, bracket) + "x = %f, y = %f, z = %f";
        EXPECT_TRUE(at != std::string::npos &&
                    std::sscanf(text.c_str() + at + words.size(), pattern.c_str(), &value[0],
                                &value[1], &value[2]) == 3)
            << words << " in\n"
            << text;
        return value;
    }

    RunOptions options() const
    {
        return {.seconds = 200,
                .environment = {{"ASAN_OPTIONS", "detect_leaks=0"}},
                .folder = folder_.path()};
    }

    TestFolder folder_;
};

std::string at_line(const std::string& text)
{
    return std::to_string(line_of(painted_source, text));
}

TEST_F(DebugTexture, GdbStopsAtALineOfTheFileWithTheValuesOfThePicture)
{
    if (const std::string why = why_no_debugger("gdb"); !why.empty()) GTEST_SKIP() << why;
    const Outcome outcome =
        debug({"--pixel", "12,8", "--texture", "paint", "--line", at_line("stripe * tint")},
              {"info args", "print stripe", "finish"});
    EXPECT_NE(outcome.out.find("paint.c:" + at_line("stripe * tint")), std::string::npos)
        << outcome.text();
    EXPECT_NE(outcome.out.find("scale = 7"), std::string::npos) << outcome.text();
    const std::array<float, 3> tint = vector_after(outcome.out, "tint = ");
    const std::array<float, 3> stripe = vector_after(outcome.out, "$1 = ");
    EXPECT_EQ(tint, (std::array<float, 3>{0.5f, 0.75f, 1.0f}));
    const std::array<float, 3> value = vector_after(outcome.out, "Value returned is $2 = ");
    for (size_t c = 0; c < 3; ++c) EXPECT_EQ(value[c], stripe[c] * tint[c]) << outcome.text();
    EXPECT_EQ(value, solo("paint", "12,8", "twin"));
    EXPECT_EQ(value, solo("paint", "12,8", "opencl"));
    EXPECT_GT(value[0], 0.0f);
}

// Over what attributes, vectors and mathematical functions are made of.
TEST_F(DebugTexture, StepStaysAmongTheUsersLines)
{
    std::string left_out;
    const std::vector<std::string> usable = debuggers(left_out);
    if (usable.empty()) GTEST_SKIP() << left_out;
    for (const std::string& debugger : usable) {
        const Outcome outcome =
            debug({"--pixel", "12,8", "--texture", "paint", "--debugger", debugger},
                  {"step", "step", "step", "step"});
        EXPECT_EQ(outcome.out.find("common/"), std::string::npos) << outcome.text();
        EXPECT_NE(outcome.out.find("paint.c:" + at_line("sin(p.x")), std::string::npos)
            << outcome.text();
    }
}

// Two nodes call one function: the arguments tell which it is.
TEST_F(DebugTexture, StopsForTheNodeThatWasNamed)
{
    if (const std::string why = why_no_debugger("gdb"); !why.empty()) GTEST_SKIP() << why;
    const Outcome left = debug({"--pixel", "12,8", "--texture", "left"}, {"info args"});
    EXPECT_NE(left.out.find("scale = 2"), std::string::npos) << left.text();
    const Outcome paint = debug({"--pixel", "12,8", "--texture", "paint"}, {"info args"});
    EXPECT_NE(paint.out.find("scale = 7"), std::string::npos) << paint.text();
}

TEST_F(DebugTexture, StopsInTheOnlyNodeWithoutItsName)
{
    if (const std::string why = why_no_debugger("gdb"); !why.empty()) GTEST_SKIP() << why;
    write_planted_scene(folder_, "float planted(float x)\n{\n    return x * 0.5f;\n}\n",
                        {{"x", 0.75}});
    std::vector<std::string> words = {
        "debug", folder_ / "scene.gltf", "--pixel", "8,4", "--execute", "info args"};
    words.insert(words.end(), planted_view.begin(), planted_view.end());
    const Outcome outcome = run_diptych(words, options());
    EXPECT_NE(outcome.out.find("planted.c:3"), std::string::npos) << outcome.text();
    EXPECT_NE(outcome.out.find("x = 0.75"), std::string::npos) << outcome.text();
}

// A name that a debugger could take for a condition, or for the end of a word.
TEST_F(DebugTexture, StopsInFilesOfAnyName)
{
    for (const auto& [debugger, name, command] :
         {std::array<std::string, 3>{"gdb", "x if 1.c", "print by"},
          std::array<std::string, 3>{"gdb", "it's.c", "print by"},
          std::array<std::string, 3>{"lldb", "it's so.c", "frame variable by"}}) {
        if (const std::string why = why_no_debugger(debugger); !why.empty()) continue;
        folder_.write(name, "// by (float; default 0.75): a factor\nfloat odd(float by)\n{\n"
                            "    return by * by;\n}\n");
        const Outcome outcome = debug({"--texture", "*.baseColor=" + (folder_ / name), "--texture",
                                       name.substr(0, name.size() - 2), "--pixel", "12,8", "--line",
                                       "4", "--debugger", debugger, "--execute", command});
        EXPECT_NE(outcome.out.find(" = 0.75"), std::string::npos) << name << outcome.text();
    }
    folder_.write("it's a.c", "float odd(void)\n{\n    return 1;\n}\n");
    const Outcome refused =
        debug({"--texture", "*.baseColor=" + (folder_ / "it's a.c"), "--texture", "it's a",
               "--pixel", "12,8", "--line", "3", "--print"});
    EXPECT_EQ(refused.exit_code, 2) << refused.text();
    EXPECT_NE(refused.err.find("it's a.c: gdb cannot be told"), std::string::npos) << refused.err;
}

// What calls the texture is no file of the user's, but debuggers find it.
TEST_F(DebugTexture, TheCallerOfATextureIsShownToo)
{
    std::string left_out;
    const std::vector<std::string> usable = debuggers(left_out);
    if (usable.empty()) GTEST_SKIP() << left_out;
    for (const std::string& debugger : usable) {
        const Outcome outcome =
            debug({"--pixel", "12,8", "--texture", "paint", "--debugger", debugger}, {"finish"});
        EXPECT_NE(outcome.out.find("return tx_result_of_float4(userProc("), std::string::npos)
            << outcome.text();
        EXPECT_NE(outcome.out.find("functions.hpp:"), std::string::npos) << outcome.text();
        EXPECT_EQ(outcome.text().find("No such file"), std::string::npos) << outcome.text();
    }
}

TEST_F(DebugTexture, GdbStepsFromLineToLineAndIntoTheTexturesOwnFunctions)
{
    if (const std::string why = why_no_debugger("gdb"); !why.empty()) GTEST_SKIP() << why;
    const Outcome outcome =
        debug({"--pixel", "12,8", "--texture", "paint", "--line", at_line("stripes(place")},
              {"print place", "break stripes", "continue", "next", "next", "print result",
               "backtrace 2", "info breakpoints"});
    EXPECT_NE(outcome.out.find("sin(p.x * scale)"), std::string::npos) << outcome.text();
    EXPECT_NE(outcome.out.find("return result;"), std::string::npos) << outcome.text();
    const std::array<float, 3> place = vector_after(outcome.out, "$1 = ");
    const std::array<float, 3> result = vector_after(outcome.out, "$2 = ");
    EXPECT_EQ(result[1], place[1]);
    EXPECT_EQ(result[2], 0.25f);
    EXPECT_NE(outcome.out.find("userProc ("), std::string::npos) << outcome.text();
}

TEST_F(DebugTexture, TX_13_BreakpointsTakeTheUsersOwnNames)
{
    if (const std::string why = why_no_debugger("gdb"); !why.empty()) GTEST_SKIP() << why;
    const Outcome outcome =
        debug({"--pixel", "12,8", "--texture", "paint"}, {"break userProc", "info breakpoints"});
    EXPECT_NE(outcome.out.find("paint.c, line " + at_line("readAttr")), std::string::npos)
        << outcome.text();
}

TEST_F(DebugTexture, LldbStopsThereToo)
{
    if (const std::string why = why_no_debugger("lldb"); !why.empty()) GTEST_SKIP() << why;
    const Outcome outcome = debug({"--pixel", "12,8", "--texture", "paint", "--debugger", "lldb",
                                   "--line", at_line("stripe * tint")},
                                  {"frame variable scale tint stripe", "finish"});
    EXPECT_NE(outcome.out.find("paint.c:" + at_line("stripe * tint")), std::string::npos)
        << outcome.text();
    EXPECT_NE(outcome.out.find("(float) scale = 7"), std::string::npos) << outcome.text();
    EXPECT_EQ(vector_after(outcome.out, "float3) tint = ", '('),
              (std::array<float, 3>{0.5f, 0.75f, 1.0f}));
    EXPECT_EQ(vector_after(outcome.out, "Return value: (user_language::float4) $0 = ", '('),
              solo("paint", "12,8", "twin"));
}

TEST_F(DebugTexture, PrintsTheCommandAndWritesALaunchFile)
{
    const Outcome shown = debug({"--pixel", "12,8", "--texture", "paint", "--print"});
    EXPECT_EQ(shown.exit_code, 0) << shown.text();
    EXPECT_EQ(shown.out.find("gdb "), 0u) << shown.out;
    for (const char* word : {"--args", "--pixel 12,8", "--debug-textures", "--backend twin",
                             "user_language::t0::userProc", "--filter box"})
        EXPECT_NE(shown.out.find(word), std::string::npos) << word << "\n" << shown.out;
    EXPECT_EQ(shown.out.find("--texture"), std::string::npos) << shown.out;
    EXPECT_EQ(shown.out.find("--print"), std::string::npos) << shown.out;

    for (int k = 0; k < 2; ++k) {  // the second takes the place of the first
        const Outcome written = debug(
            {"--pixel", "12,8", "--texture", "paint", "--line", at_line("stripe *"), "--vscode"});
        EXPECT_EQ(written.exit_code, 0) << written.text();
    }
    std::ifstream in(folder_ / ".vscode/launch.json");
    const nlohmann::json launch = nlohmann::json::parse(in);
    ASSERT_EQ(launch.at("configurations").size(), 1u);
    const nlohmann::json& configuration = launch["configurations"][0];
    EXPECT_EQ(configuration.at("type"), "cppdbg");
    EXPECT_NE(configuration.at("setupCommands").dump().find("paint.c:" + at_line("stripe *")),
              std::string::npos);
    EXPECT_EQ(configuration.at("args").at(0), "render");
}

// As VS Code itself begins the file, and as people go on with it.
TEST_F(DebugTexture, ALaunchFileKeepsWhatPeopleWroteInIt)
{
    const std::string head = "{\n    // Use IntelliSense, see \"configurations\": [ of {\n"
                             "    \"inputs\": [{\"id\": \"configurations\"}], /* [ */\n"
                             "    \"configurations\": [ // all\n"
                             "        {\"name\": \"a // b\", \"args\": [\"\\\"]\"]}";
    const std::string tail = ", // the last, so far\n    ],\n    \"version\": \"0.2.0\",\n}\n";
    std::filesystem::create_directory(folder_ / ".vscode");
    folder_.write(".vscode/launch.json", head + tail);
    const auto write = [&](const std::string& line) {
        return debug({"--pixel", "12,8", "--texture", "paint", "--line", line, "--vscode"});
    };
    const auto text = [&] {
        std::ifstream in(folder_ / ".vscode/launch.json");
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    for (const std::string line : {"4", "5"}) {  // the second takes the place of the first
        const Outcome written = write(line);
        ASSERT_EQ(written.exit_code, 0) << written.text();
        ASSERT_TRUE(text().starts_with(head + ",\n        {")) << text();
        ASSERT_TRUE(text().ends_with("}" + tail)) << text();
        const std::string added =
            text().substr(head.size() + 1, text().size() - head.size() - tail.size() - 1);
        const nlohmann::json configuration = nlohmann::json::parse(added, nullptr, false);
        ASSERT_TRUE(configuration.is_object()) << text();
        EXPECT_EQ(configuration.at("name"), "diptych: paint at 12,8");
        EXPECT_NE(configuration.at("setupCommands").dump().find("paint.c:" + line),
                  std::string::npos)
            << added;
    }
    std::string commented = text();
    commented.insert(commented.find("cppdbg"), "gdb\", // mine\n\"type\": \"");
    folder_.write(".vscode/launch.json", commented);
    const Outcome kept = write("4");
    EXPECT_EQ(kept.exit_code, 2) << kept.text();
    EXPECT_EQ(kept.err, "diptych: .vscode/launch.json: there are comments in its configuration "
                        "\"diptych: paint at 12,8\", which would be lost; give it another name\n");
    EXPECT_EQ(text(), commented);
    for (const char* wrong : {"{\"configurations\": {}}", "{\"configurations\": [}", "[] //",
                              "{\"\\u0063onfigurations\": []}"}) {
        folder_.write(".vscode/launch.json", wrong);
        const Outcome refused = write("4");
        EXPECT_EQ(refused.exit_code, 2) << refused.text();
        EXPECT_EQ(refused.err, "diptych: .vscode/launch.json: is not JSON with a list of "
                               "configurations, comments aside; repair it, or move it away\n");
        EXPECT_EQ(text(), wrong);
    }
}

TEST_F(DebugTexture, SaysWhyItCannotStop)
{
    const auto expect_refusal = [&](const std::vector<std::string>& more,
                                    const std::vector<std::string>& names) {
        const Outcome outcome = debug(more);
        EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
        EXPECT_EQ(outcome.err_lines().size(), 1u) << outcome.text();
        for (const std::string& name : names)
            EXPECT_NE(outcome.err.find(name), std::string::npos) << name << "\n" << outcome.err;
    };
    expect_refusal({"--texture", "paint"}, {"--pixel"});
    expect_refusal({"--pixel", "12,8"}, {"paint", "left"});
    expect_refusal({"--pixel", "12,8", "--texture", "varnish"}, {"varnish", "paint"});
    expect_refusal({"--pixel", "30,8", "--texture", "paint"}, {"plain", "painted"});
    expect_refusal({"--pixel", "0,0", "--texture", "paint"}, {"no surface", "painted"});
    expect_refusal({"--pixel", "12,8", "--texture", "paint", "--line", "99"}, {"99", "paint.c"});
    expect_refusal({"--pixel", "12,8", "--texture", "paint", "--debugger", "adb"}, {"adb", "gdb"});
    expect_refusal({"--pixel", "12,8", "--texture", "paint", "--backend", "opencl"}, {"twin"});
    expect_refusal({"--pixel", "40,8", "--texture", "paint"}, {"40,8"});
}

// Hits of a device, run again on the host.
class Replay : public DebugTexture {
protected:
    Outcome capture(const std::string& backend, const std::string& file = "hits.json")
    {
        return run_diptych(with_view({"render", folder_ / "scene.gltf", "--samples", "3", "--pixel",
                                      "12,8", "--backend", backend, "--capture", file}),
                           options());
    }
    Outcome replay(std::vector<std::string> more)
    {
        std::vector<std::string> words = {"debug", "--replay", "hits.json"};
        words.insert(words.end(), more.begin(), more.end());
        return run_diptych(words, options());
    }
    std::string file() const
    {
        std::ifstream in(folder_ / "hits.json");
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

TEST_F(Replay, HasTheDevicesBits)
{
    for (const char* backend : {"twin", "opencl", "cpu", "double"}) {
        const Outcome captured = capture(backend);
        if (captured.exit_code == 2 && captured.err.find("OpenCL") != std::string::npos) continue;
        ASSERT_EQ(captured.exit_code, 0) << captured.text();
        const Outcome replayed = replay({"--print"});
        EXPECT_EQ(replayed.exit_code, 0) << replayed.text();
        EXPECT_NE(replayed.out.find("sample 2 bounce 0: paint: userProc(scale = 7, tint = (0.5, "
                                    "0.75, 1)) gave ("),
                  std::string::npos)
            << replayed.text();
        EXPECT_NE(replayed.out.find("results have the device's bits"), std::string::npos);
        EXPECT_NE(replayed.out.find(std::string(" on ") + backend), std::string::npos);
    }
}

TEST_F(Replay, StopsInTheDebuggerWithTheDevicesValue)
{
    if (const std::string why = why_no_debugger("gdb"); !why.empty()) GTEST_SKIP() << why;
    const Outcome captured = capture("opencl");
    if (captured.exit_code == 2) GTEST_SKIP() << captured.err;
    const Outcome outcome = replay({"--texture", "paint", "--line", at_line("stripe * tint"),
                                    "--execute", "info args", "--execute", "finish"});
    EXPECT_NE(outcome.out.find("scale = 7"), std::string::npos) << outcome.text();
    EXPECT_EQ(vector_after(outcome.out, "Value returned is $1 = "),
              solo("paint", "12,8", "opencl"));
}

TEST_F(Replay, RunsTheEditedCopyOfTheGeneratedCode)
{
    const Outcome captured = capture("twin");
    ASSERT_EQ(captured.exit_code, 0) << captured.text();
    ASSERT_EQ(replay({"--print", "--generated-dir", "code"}).exit_code, 0);
    EXPECT_EQ(replay({"--print", "--use-generated", "code"}).exit_code, 0);

    std::ifstream in(folder_ / "code/functions.hpp");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const size_t at = text.find("stripe * tint");
    ASSERT_NE(at, std::string::npos) << text;
    folder_.write("code/functions.hpp", text.insert(at, "0.5f * "));
    const Outcome edited = replay({"--print", "--use-generated", "code"});
    EXPECT_EQ(edited.exit_code, 1) << edited.text();
    EXPECT_NE(edited.out.find(": the device has "), std::string::npos) << edited.text();
    const Outcome refused =
        replay({"--print", "--generated-dir", "code", "--use-generated", "code"});
    EXPECT_EQ(refused.exit_code, 2) << "it would be overwritten";
    if (const std::string why = why_no_debugger("gdb"); !why.empty()) GTEST_SKIP() << why;
    const auto value_returned = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"--texture", "paint", "--line", at_line("stripe * tint"),
                                          "--execute", "finish"};
        words.insert(words.end(), more.begin(), more.end());
        return vector_after(replay(words).out, "Value returned is $1 = ");
    };
    const std::array<float, 3> whole = value_returned({}),
                               half = value_returned({"--use-generated", "code"});
    for (size_t c = 0; c < 3; ++c) EXPECT_EQ(half[c], 0.5f * whole[c]);
}

TEST_F(Replay, SaysWhatIsWrongWithTheFile)
{
    const auto expect_refusal = [&](const std::string& says) {
        const Outcome outcome = replay({"--print"});
        EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
        EXPECT_EQ(outcome.err_lines().size(), 1u) << outcome.text();
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
    };
    expect_refusal("cannot be read");
    ASSERT_EQ(capture("twin").exit_code, 0);
    const std::string whole = file();
    folder_.write("hits.json", whole.substr(0, whole.size() / 2));
    expect_refusal("cut short");
    std::string other = whole;
    const size_t at = other.find("depth");
    other[at] = 'D';
    folder_.write("hits.json", other);
    expect_refusal("damaged");
    other = whole;
    other.replace(other.find("\"version\":1"), 11, "\"version\":9");
    folder_.write("hits.json", other);
    expect_refusal("version");
    folder_.write("hits.json", "{}");
    expect_refusal("no capture");
    folder_.write("hits.json", whole);
    folder_.write("paint.c", painted_source + "// changed\n");
    std::string changed = painted_source;
    changed.replace(changed.find("0.25f"), 5, "0.75f");
    folder_.write("paint.c", changed);
    expect_refusal("not what was captured");
    const Outcome no_pixel =
        run_diptych(with_view({"render", folder_ / "scene.gltf", "--capture", "x"}), options());
    EXPECT_EQ(no_pixel.exit_code, 2);
    EXPECT_NE(no_pixel.err.find("--pixel"), std::string::npos) << no_pixel.err;
}

}  // namespace
