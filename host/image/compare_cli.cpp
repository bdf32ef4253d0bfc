#include "host/image/compare_cli.hpp"

#include "host/image/view_transform.hpp"

#include <CLI/CLI.hpp>

namespace diptych::image {

// `--json A B` means the pictures A and B: the optional name after the flag took the first of them.
static void give_back_picture(CompareOptions& options)
{
    const std::string& last = options.backends.empty() ? options.test : options.reference;
    if (options.json_file.empty() || !last.empty() || !options.manifest.empty()) return;
    options.test = options.reference;
    options.reference = options.json_file;
    options.json_file.clear();
}

static const char* const FOOTER =
    R"(Metrics of test B against reference A, over all pixels and colour channels:
  rmse         root of the mean squared difference
  relmse       mean of (b - a)^2 / (a^2 + 0.01 mean(a)^2)
  mean, max    mean and largest absolute difference
  bias         mean of b - a, with its 95 % interval when a picture has the layer standard_error
  flip.mean    FLIP, what a viewer notices when flipping between the two: LDR for 8- and 16-bit
               pictures, HDR for floating point; also flip.median, flip.p99 (99th percentile), flip.max
  jnd.rms      just noticeable differences from pixel to pixel, as of render --error, of what a
               display shows through --exposure and --view; also jnd.p95 (95th percentile)
  jnd.blocks   share of the blocks (16 x 16 pixels, 8 x 8 below half a megapixel) with an RMS above 1
  jnd.broken   where B has the layer predicted_error: of the pixels that it predicts within 1 JND,
               the share that is not
  yee          share of pixels that OpenImageIO's perceptual comparison tells apart (by their colour
               only: its luminance test has no effect in OpenImageIO 2.4)
LDR pictures are compared in their sRGB values, 0 to 1; EXR, HDR and float TIFF in linear values.

A manifest is a JSON list, paths relative to it:
  [{"name": "box", "reference": "box.ref.exr", "test": "box.exr", "limits": {"flip.mean": 0.03}}]
each item may also have "layer", "ppd" and "heat_map".

Exit code: 0 within all given limits, 1 outside, 2 on error (pictures of different size included).)";

CLI::App* add_compare_command(CLI::App& app, CompareOptions& options)
{
    CLI::App* command = app.add_subcommand(
        "compare", "Compare two pictures, a list of pairs, or two backends on a scene");
    command->footer(FOOTER);
    command->add_option("A", options.reference, "Reference picture; with --backends, the scene");
    command->add_option("B", options.test, "Picture under test, of the same size");
    command
        ->add_option("--metric", options.metrics,
                     "What to measure (repeat for more; all when not given)")
        ->type_name("NAME")
        ->allow_extra_args(false);
    command
        ->add_option("--max", options.limits,
                     "Limit of the metric in the same place: one for each --metric, or none")
        ->type_name("VALUE")
        ->allow_extra_args(false);
    command
        ->add_option("--layer", options.layer,
                     "Compare this layer of EXR files instead of the colours")
        ->type_name("NAME");
    command->add_option("-o,--output", options.heat_map, "Write the FLIP map in magma colours")
        ->type_name("FILE");
    command
        ->add_option("--ppd", options.pixels_per_degree,
                     "Pixels per degree of sight for FLIP (67.02 when not given)")
        ->type_name("NUMBER");
    command->add_option("--exposure", options.viewer.exposure, "Stops, for jnd")
        ->capture_default_str();
    command
        ->add_option_function<std::string>(
            "--view",
            [&options](const std::string& name) { options.viewer.view = view_of_name(name); },
            "How radiance becomes display colours, for jnd: standard (when not given), neutral or "
            "filmic")
        ->type_name("NAME");
    CLI::Option* json = command->add_option_function<std::vector<std::string>>(
        "--json",
        [&options](const std::vector<std::string>& file) {
            options.json = true;
            options.json_file = file.empty() ? "" : file.front();
        },
        "Print one JSON object instead of text, or write it to FILE beside the text (put it after "
        "A and B)");
    json->expected(0, 1)->allow_extra_args(false)->type_name("[FILE]");
    CLI::Option* manifest = command->add_option("--manifest", options.manifest,
                                                "Run the comparisons listed in a JSON file");
    manifest->type_name("FILE");
    command
        ->add_option(
            "--junit", options.junit,
            "Where the manifest's results go as JUnit XML (standard output when not given)")
        ->type_name("FILE")
        ->needs(manifest);
    command
        ->add_option("--backends", options.backends,
                     "Render scene A on two backends with the same samples and compare those")
        ->type_name("A,B");
    command->parse_complete_callback([&options] { give_back_picture(options); });
    return command;
}

}  // namespace diptych::image
