#include "host/render/checkpoint.hpp"

#include "host/render/checksum.hpp"
#include "host/render/safe_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>

namespace diptych {
namespace {

using nlohmann::json;

constexpr char magic[8] = {'D', 'I', 'P', 'T', 'Y', 'C', 'H', 'K'};
constexpr size_t longest_header = 16u << 20;
constexpr const char* render_anew = "render anew with --restart, or name another file";

[[noreturn]] void refuse(const std::string& path, const std::string& what)
{
    throw std::runtime_error(fmt::format("{}: {}; {}", path, what, render_anew));
}

// Every array of a film, in the order of the file. The list of members is whole, or it does not
// compile.
template<class Data, class Function>
void for_each_array(Data& data, Function&& function)
{
    auto& [window, batches, radiance, batch_samples, alpha, albedo, normal, distance, object,
           material, faults, texture_faults, aovs, aov_values] = data;
    function("radiance", radiance);
    function("batch_samples", batch_samples);
    function("alpha", alpha);
    function("albedo", albedo);
    function("normal", normal);
    function("distance", distance);
    function("object", object);
    function("material", material);
    if (!aovs.empty()) function("aovs", aov_values);
}

template<class Value>
size_t bytes_of(const std::vector<Value>& array)
{
    return array.size() * sizeof(Value);
}

std::string hexadecimal(const void* data, size_t bytes)
{
    std::string text;
    const std::span from(static_cast<const unsigned char*>(data), bytes);
    for (const unsigned char byte : from) text += fmt::format("{:02x}", byte);
    return text;
}

Settings settings_from(const std::string& text)
{
    Settings settings = {};
    if (text.size() != 2 * sizeof settings) throw std::runtime_error("settings");
    auto* to = reinterpret_cast<unsigned char*>(&settings);
    for (size_t k = 0; k < sizeof settings; ++k)
        to[k] = static_cast<unsigned char>(std::stoul(text.substr(2 * k, 2), nullptr, 16));
    return settings;
}

json json_of(const Slice& slice)
{
    const Schedule& schedule = slice.schedule;
    return {{"first", slice.first},
            {"end", slice.end},
            {"error", slice.error},
            {"timed", slice.is_timed},
            {"unbiased", slice.is_unbiased},
            {"round", schedule.round},
            {"level", schedule.level},
            {"pilot", schedule.pilot},
            {"turn", schedule.turn},
            {"blocks", schedule.blocks.size()},
            {"exposure", slice.viewer.exposure},
            {"view", int(slice.viewer.view)}};
}

Slice slice_from(const json& in)
{
    Slice slice;
    slice.first = in.at("first");
    slice.end = in.at("end");
    slice.error = in.at("error");
    slice.is_timed = in.at("timed");
    slice.is_unbiased = in.at("unbiased");
    slice.viewer = {in.at("exposure"), image::View(in.at("view").get<int>())};
    slice.schedule.round = in.at("round");
    slice.schedule.level = in.at("level");
    slice.schedule.pilot = in.at("pilot");
    slice.schedule.turn = in.at("turn");
    slice.schedule.blocks.resize(in.at("blocks").get<size_t>());
    return slice;
}

std::string header_text(const CheckpointHead& head, const Film& film)
{
    const FilmData& data = film.data();
    json slices = json::array(), arrays = json::array();
    for (const Slice& slice : head.slices) slices.push_back(json_of(slice));
    for_each_array(data, [&](const char* name, const auto& array) {
        arrays.push_back({name, bytes_of(array)});
    });
    json aovs = json::array();
    for (const TextureAov& aov : data.aovs) aovs.push_back({aov.node, aov.channels});
    const Faults& faults = data.faults;
    json texture_faults = json::array();
    for (const TextureFault& fault : data.texture_faults.of_kind)
        texture_faults.push_back(
            {fault.count, fault.x, fault.y, fault.first_sample, fault.samples});
    const json header = {
        {"program", head.subject.program},
        {"scene", head.subject.scene},
        {"settings", hexadecimal(&head.subject.settings, sizeof head.subject.settings)},
        {"backends", head.backends},
        {"block_shift", head.block_shift},
        {"slices", slices},
        {"planned", head.planned},
        {"seconds", head.seconds},
        {"rays", head.rays},
        {"paths", head.paths},
        {"width", film.width()},
        {"height", film.height()},
        {"batches", data.batches},
        {"aovs", aovs},
        {"faults", {faults.count, faults.x, faults.y, faults.first_sample}},
        {"texture_faults", texture_faults},
        {"done", fraction_done(head)},
        {"arrays", arrays},
    };
    std::string text = header.dump();
    text.resize((text.size() + 7) / 8 * 8, ' ');
    return text;
}

void expect(bool condition)
{
    if (!condition) throw std::runtime_error("header");
}

// Blocks have no contents yet. left: the file's bytes after the header, which memory is not asked
// to exceed.
CheckpointHead head_from(const json& in, size_t left)
{
    CheckpointHead head{{in.at("program"), in.at("scene"), settings_from(in.at("settings"))},
                        in.at("backends"),
                        in.at("block_shift"),
                        {},
                        in.value("planned", 0),
                        in.at("seconds"),
                        in.at("rays"),
                        in.at("paths")};
    for (const json& aov : in.value("aovs", json::array())) {
        head.subject.aovs.push_back({aov.at(0), aov.at(1)});
        expect(head.subject.aovs.back().channels >= 1 && head.subject.aovs.back().channels <= 4);
    }
    for (const json& slice : in.at("slices")) {
        expect(slice.at("blocks").get<size_t>() <= left);
        head.slices.push_back(slice_from(slice));
    }
    return head;
}

// The header's side of a checkpoint: everything but the arrays, which have their sizes.
Checkpoint checkpoint_from(const json& in, size_t left)
{
    CheckpointHead head = head_from(in, left);
    const int width = in.at("width"), height = in.at("height"), batches = in.at("batches");
    expect(width > 0 && height > 0 && width < 1 << 16 && height < 1 << 16);
    expect(batches > 0 && batches <= batch_count);
    expect(Film::bytes({0, 0, width, height}, batches, head.subject.aovs.size()) <= left);
    Film film(width, height, {0, 0, width, height}, batches, head.subject.aovs);
    const json& faults = in.at("faults");
    film.data().faults = {faults.at(0), faults.at(1), faults.at(2), faults.at(3)};
    const json& texture_faults = in.at("texture_faults");
    auto& of_kind = film.data().texture_faults.of_kind;
    for (size_t kind = 0; kind < of_kind.size(); ++kind) {
        const json& fault = texture_faults.at(kind);
        of_kind[kind] = {fault.at(0), fault.at(1), fault.at(2), fault.at(3), fault.at(4)};
    }
    size_t k = 0;
    for_each_array(film.data(), [&](const char* name, const auto& array) {
        const json& stated = in.at("arrays").at(k++);
        expect(stated.at(0) == name && stated.at(1) == bytes_of(array));
    });
    return {std::move(head), std::move(film)};
}

// Blocks as the file holds them.
struct StoredBlock {
    std::int32_t quanta, target, is_done, error, worst_pixel;
};

class Reader {
public:
    explicit Reader(const std::string& path) : path_(path), in_(path, std::ios::binary)
    {
        std::error_code error;
        if (!std::filesystem::is_regular_file(path, error))
            throw std::runtime_error(path + ": no such file; name a checkpoint");
        size_ = std::filesystem::file_size(path, error);
        if (!in_ || error)
            throw std::runtime_error(fmt::format("{}: cannot be read ({}); check that it is yours "
                                                 "to read",
                                                 path, std::strerror(errno)));
    }

    void read(void* to, size_t bytes)
    {
        if (bytes > left()) refuse(path_, fmt::format("is cut short: it has {} bytes", size_));
        if (!in_.read(static_cast<char*>(to), std::streamsize(bytes)))
            throw std::runtime_error(path_ + ": could not be read to its end; check the disk");
        at_ += bytes;
        sum_.add(to, bytes);
    }
    template<class Value>
    Value value()
    {
        Value value;
        read(&value, sizeof value);
        return value;
    }
    void expect_checksum(const char* of)
    {
        const std::uint64_t right = sum_.value();
        if (value<std::uint64_t>() != right)
            refuse(path_, fmt::format("is corrupt: the checksum of its {} does not match", of));
    }
    // What is passed over is not in the checksum.
    void skip(size_t bytes)
    {
        if (bytes > left()) refuse(path_, fmt::format("is cut short: it has {} bytes", size_));
        in_.seekg(std::streamoff(bytes), std::ios::cur);
        at_ += bytes;
    }
    size_t left() const { return size_ - at_; }

private:
    std::string path_;
    std::ifstream in_;
    size_t size_ = 0;
    size_t at_ = 0;
    Checksum sum_;
};

// Runs a function that reads from the header. Its checksum matches, so what it says is what some
// program wrote; that may have been another one.
template<class Function>
auto understood(const std::string& path, Function&& function)
{
    try {
        return function();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {
        refuse(path, "is cut short, or has a header that this program does not understand");
    }
}

json read_header(const std::string& path, Reader& reader)
{
    char start[sizeof magic] = {};
    if (reader.left() >= sizeof start) reader.read(start, sizeof start);
    if (std::memcmp(start, magic, sizeof magic) != 0)
        refuse(path, "is no checkpoint, or is corrupt from its first bytes");
    const auto version = reader.value<std::uint32_t>();
    if (version != checkpoint_version)
        refuse(path, fmt::format("is a checkpoint of format version {}; this program reads {}",
                                 version, checkpoint_version));
    std::string header(std::min<size_t>(reader.value<std::uint32_t>(), longest_header), ' ');
    reader.read(header.data(), header.size());
    reader.expect_checksum("header");
    return understood(path, [&] { return json::parse(header); });
}

void read_blocks(Reader& reader, std::vector<Slice>& slices)
{
    for (Slice& slice : slices)
        for (BlockState& block : slice.schedule.blocks) {
            const auto stored = reader.value<StoredBlock>();
            block.quanta = stored.quanta;
            block.target = stored.target;
            block.is_done = stored.is_done != 0;
            block.error = {stored.error, stored.worst_pixel};
        }
}

size_t bytes_after_header(const Checkpoint& checkpoint)
{
    size_t bytes = sizeof(std::uint64_t);
    for_each_array(checkpoint.film.data(),
                   [&](const char*, const auto& array) { bytes += bytes_of(array); });
    for (const Slice& slice : checkpoint.head.slices)
        bytes += slice.schedule.blocks.size() * sizeof(StoredBlock);
    return bytes;
}

class Writer {
public:
    explicit Writer(SafeFile& file) : file_(file) {}

    void write(const void* data, size_t bytes)
    {
        // by pieces that stay in the cache from the checksum to the copy
        const char* from = static_cast<const char*>(data);
        for (size_t at = 0; at < bytes; at += piece) {
            const size_t length = std::min(piece, bytes - at);
            sum_.add(from + at, length);
            file_.write(from + at, length);
        }
    }
    void write_checksum()
    {
        const std::uint64_t sum = sum_.value();
        write(&sum, sizeof sum);
    }

private:
    static constexpr size_t piece = 256u << 10;
    SafeFile& file_;
    Checksum sum_;
};

}  // namespace

Slice slice_of(const RenderOptions& options)
{
    return {options.first_sample, options.samples, {}, options.error, options.time_limit > 0,
            options.is_unbiased,  options.viewer};
}

std::vector<Quantum> plan_of(const Slice& slice)
{
    RenderOptions options;
    options.first_sample = slice.first;
    options.samples = slice.end;
    options.time_limit = slice.is_timed ? 1 : 0;
    return plan_of(options);
}

int done_end(const Slice& slice)
{
    const std::vector<Quantum> plan = plan_of(slice);
    int quanta = 0;
    for (const BlockState& block : slice.schedule.blocks) quanta = std::max(quanta, block.quanta);
    if (quanta == 0) return slice.first;
    const Quantum& last = plan.at(size_t(quanta) - 1);
    return last.first_sample + last.samples;
}

bool is_complete(const Slice& slice)
{
    const int whole = int(plan_of(slice).size());
    return std::all_of(
        slice.schedule.blocks.begin(), slice.schedule.blocks.end(),
        [&](const BlockState& block) { return block.quanta >= whole || block.is_done; });
}

// Blocks that have come to an error target ask for no more.
double fraction_done(const CheckpointHead& head)
{
    double done = 0, all = 0;
    for (const Slice& slice : head.slices) {
        const int whole = int(plan_of(slice).size());
        for (const BlockState& block : slice.schedule.blocks) {
            done += block.quanta;
            all += block.is_done ? block.quanta : whole;
        }
    }
    return all > 0 ? done / all : 0;
}

void write_checkpoint(SafeFile& file, const CheckpointHead& head, const Film& film)
{
    const std::string header = header_text(head, film);
    const std::uint32_t numbers[2] = {checkpoint_version, std::uint32_t(header.size())};
    Writer writer(file);
    writer.write(magic, sizeof magic);
    writer.write(numbers, sizeof numbers);
    writer.write(header.data(), header.size());
    writer.write_checksum();
    for_each_array(film.data(), [&](const char*, const auto& array) {
        writer.write(array.data(), bytes_of(array));
    });
    for (const Slice& slice : head.slices) {
        std::vector<StoredBlock> blocks;
        for (const BlockState& block : slice.schedule.blocks)
            blocks.push_back({block.quanta, block.target, block.is_done, block.error.rms,
                              block.error.worst_pixel});
        writer.write(blocks.data(), blocks.size() * sizeof(StoredBlock));
    }
    writer.write_checksum();
}

Checkpoint read_checkpoint(const std::string& path)
{
    Reader reader(path);
    const json header = read_header(path, reader);
    Checkpoint checkpoint =
        understood(path, [&] { return checkpoint_from(header, reader.left()); });
    if (reader.left() != bytes_after_header(checkpoint))
        refuse(path, fmt::format("is cut short or too long: {} bytes follow its header where {} "
                                 "are expected",
                                 reader.left(), bytes_after_header(checkpoint)));
    for_each_array(checkpoint.film.data(),
                   [&](const char*, auto& array) { reader.read(array.data(), bytes_of(array)); });
    read_blocks(reader, checkpoint.head.slices);
    reader.expect_checksum("sums");
    return checkpoint;
}

CheckpointHead read_checkpoint_head(const std::string& path)
{
    Reader reader(path);
    const json header = read_header(path, reader);
    CheckpointHead head = understood(path, [&] { return head_from(header, reader.left()); });
    reader.skip(understood(path, [&] {
        size_t bytes = 0;
        for (const json& array : header.at("arrays")) bytes += array.at(1).get<size_t>();
        return bytes;
    }));
    read_blocks(reader, head.slices);
    return head;
}

double fraction_done(const std::string& path)
{
    Reader reader(path);
    const json header = read_header(path, reader);
    return understood(path, [&] { return header.at("done").get<double>(); });
}

}  // namespace diptych
