#include "host/render/checkpoint_merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace diptych {
namespace {

template<class Value>
void add_to(std::vector<Value>& sums, const std::vector<Value>& more)
{
    for (size_t k = 0; k < sums.size(); ++k) sums[k] += more[k];
}

std::string samples_text(int first, int end) { return fmt::format("samples {}..{}", first, end); }

void refuse_overlap(const Slice& a, const std::string& name_a, const Slice& b,
                    const std::string& name_b)
{
    const int first = std::max(a.first, b.first);
    const int end = std::min(done_end(a), done_end(b));
    if (first < end)
        throw std::runtime_error(fmt::format("{} and {}: both hold {}; merge slices that are apart",
                                             name_a, name_b, samples_text(first, end)));
}

// Complete and uniform: all blocks have the same samples.
bool is_uniform(const Slice& slice)
{
    const int whole = int(plan_of(slice).size());
    return std::all_of(slice.schedule.blocks.begin(), slice.schedule.blocks.end(),
                       [&](const BlockState& block) { return block.quanta >= whole; });
}

// As one they are what a single render would be.
bool may_join(const Slice& a, const Slice& b)
{
    return a.end % QUANTUM == 0 && is_uniform(a) && !a.is_timed && !b.is_timed &&
           a.schedule.pilot == 0 && b.schedule.pilot == 0;
}

void join_neighbours(std::vector<Slice>& slices)
{
    std::sort(slices.begin(), slices.end(),
              [](const Slice& a, const Slice& b) { return a.first < b.first; });
    for (size_t k = 0; k + 1 < slices.size();) {
        Slice &a = slices[k], &b = slices[k + 1];
        if (a.end != b.first || !may_join(a, b)) {
            ++k;
            continue;
        }
        const int quanta = int(plan_of(a).size());
        for (size_t block = 0; block < a.schedule.blocks.size(); ++block) {
            a.schedule.blocks[block] = b.schedule.blocks.at(block);
            a.schedule.blocks[block].quanta += quanta;
            a.schedule.blocks[block].target += quanta;
        }
        a.end = b.end;
        a.error = b.error;
        slices.erase(slices.begin() + std::ptrdiff_t(k) + 1);
    }
}

// The first is the one that comes first in the order of samples.
template<class Fault>
Fault merged_faults(const Fault& a, const Fault& b)
{
    Fault faults = a.count == 0 || (b.count > 0 && b.first_sample < a.first_sample) ? b : a;
    faults.count = a.count + b.count;
    return faults;
}

// Same size.
void add_film(Film& film, const Film& more)
{
    const int batches = std::max(film.data().batches, more.data().batches);
    film = with_batches(std::move(film), batches);
    const Film wide = with_batches(more, batches);
    // The list of members is whole, or it does not compile.
    auto& [window, batch_number, radiance, batch_samples, alpha, albedo, normal, distance, object,
           material, faults, texture_faults, aovs, aov_values] = film.data();
    const FilmData& data = wide.data();
    add_to(radiance, data.radiance);
    add_to(batch_samples, data.batch_samples);
    add_to(alpha, data.alpha);
    add_to(albedo, data.albedo);
    add_to(normal, data.normal);
    add_to(distance, data.distance);
    add_to(aov_values, data.aov_values);  // of the same nodes: they are part of the subject
    for (size_t p = 0; p < object.size(); ++p) {
        object[p] = std::max(object[p], data.object[p]);  // -1 in all slices but the first
        material[p] = std::max(material[p], data.material[p]);
    }
    faults = merged_faults(faults, data.faults);
    for (size_t kind = 0; kind < texture_faults.of_kind.size(); ++kind) {
        TextureFault& fault = texture_faults.of_kind[kind];
        fault = merged_faults(fault, data.texture_faults.of_kind[kind]);
    }
}

// Whether the quanta of both plans before sample `end` are the same.
bool begins_alike(const std::vector<Quantum>& a, const std::vector<Quantum>& b, int end)
{
    for (size_t q = 0; q < a.size() && a[q].first_sample < end; ++q)
        if (q >= b.size() || a[q].first_sample != b[q].first_sample || a[q].samples != b[q].samples)
            return false;
    return true;
}

}  // namespace

Film with_batches(Film film, int batches)
{
    const FilmData& from = film.data();
    if (from.batches >= batches) return film;
    Film wide(film.width(), film.height(), from.window, batches);
    FilmData& to = wide.data();
    const size_t few = size_t(from.batches), many = size_t(batches);
    for (size_t p = 0; p < from.window.pixels(); ++p)
        for (size_t b = 0; b < few; ++b) {
            to.batch_samples[p * many + b] = from.batch_samples[p * few + b];
            for (size_t c = 0; c < 3; ++c)
                to.radiance[(p * many + b) * 3 + c] = from.radiance[(p * few + b) * 3 + c];
        }
    FilmData rest = std::move(film.data());
    rest.radiance = std::move(to.radiance);
    rest.batch_samples = std::move(to.batch_samples);
    rest.batches = batches;
    to = std::move(rest);
    return wide;
}

void expect_mergeable(const CheckpointHead& a, const std::string& name_a, const CheckpointHead& b,
                      const std::string& name_b)
{
    const std::string difference = difference_between(a.subject, b.subject);
    if (!difference.empty())
        throw std::runtime_error(fmt::format("{} and {}: differ in {}; merge slices of one picture",
                                             name_a, name_b, difference));
    if (a.block_shift != b.block_shift)
        throw std::runtime_error(fmt::format("{} and {}: differ in the size of blocks; merge "
                                             "slices that were rendered with the same settings",
                                             name_a, name_b));
    for (const Slice& one : a.slices)
        for (const Slice& other : b.slices) refuse_overlap(one, name_a, other, name_b);
}

void add_checkpoint(Checkpoint& all, const Checkpoint& more)
{
    add_film(all.film, more.film);
    CheckpointHead& head = all.head;
    head.slices.insert(head.slices.end(), more.head.slices.begin(), more.head.slices.end());
    join_neighbours(head.slices);
    for (const std::string& backend : more.head.backends)
        if (std::count(head.backends.begin(), head.backends.end(), backend) == 0)
            head.backends.push_back(backend);
    std::sort(head.backends.begin(), head.backends.end());
    head.planned = std::max(head.planned, more.head.planned);
    head.seconds += more.head.seconds;
    head.rays += more.head.rays;
    head.paths += more.head.paths;
}

void expect_same_subject(const CheckpointHead& head, const std::string& name,
                         const CheckpointSubject& subject)
{
    const std::string difference = difference_between(head.subject, subject);
    if (!difference.empty())
        throw std::runtime_error(
            fmt::format("{}: is of another picture: it and this render differ in {}; name "
                        "another file, or begin anew with --restart",
                        name, difference));
}

void expect_same_plan(const CheckpointHead& head, const std::string& name, const Settings& settings,
                      const RenderOptions& options)
{
    const auto refuse = [&](const std::string& what) {
        throw std::runtime_error(name + ": " + what + ", or begin anew with --restart");
    };
    if (head.slices.size() != 1) refuse("holds samples that are apart, merged; name another file");
    const Slice& slice = head.slices[0];
    const Slice wanted = slice_of(options);
    const int done = done_end(slice);
    if (slice.first != wanted.first)
        refuse(fmt::format("holds {}, not from {} on; ask for the same --range",
                           samples_text(slice.first, slice.end), wanted.first));
    if (done > wanted.end)
        refuse(fmt::format("holds {}, more than up to {}; ask for at least as many",
                           samples_text(wanted.first, done), wanted.end));
    if (head.block_shift != grid_of(settings, options).shift || slice.is_timed != wanted.is_timed ||
        slice.is_unbiased != wanted.is_unbiased)
        refuse("was rendered to another kind of target (--samples, --error, --time, --unbiased); "
               "ask for the same kind");
    if (!begins_alike(plan_of(slice), plan_of(wanted), done))
        refuse(fmt::format("holds {}, which ends within a group of {} samples; name another file",
                           samples_text(wanted.first, done), QUANTUM));
}

RenderState continued(Checkpoint checkpoint, const std::string& name, const Settings& settings,
                      const RenderOptions& options)
{
    expect_same_plan(checkpoint.head, name, settings, options);
    Slice slice = std::move(checkpoint.head.slices[0]);
    const Slice wanted = slice_of(options);
    const int whole = int(plan_of(wanted).size());
    if (wanted.end != slice.end || wanted.error != slice.error || wanted.viewer != slice.viewer)
        for (BlockState& block : slice.schedule.blocks) {
            block.is_done = false;
            block.target = std::min(block.target, whole);
        }
    const int batches =
        is_adaptive(options) ? batch_count : batches_of(wanted.end, settings.sequence_quanta);
    return {with_batches(std::move(checkpoint.film), batches), std::move(slice.schedule)};
}

}  // namespace diptych
