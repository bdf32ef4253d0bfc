#include "host/live/live_render.hpp"

#include "host/scene/uri.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace diptych {
namespace {

// A dispatch takes about this long, so that an edit is noticed at once.
constexpr double dispatch_seconds = 0.02;
// Pictures are shown every second, or less often where showing one takes long.
constexpr double show_every = 1;
constexpr double show_share = 0.1;
// A save in several steps is broken in between: its error is told only when nothing follows.
constexpr double hold_seconds = 0.15;
constexpr double idle_seconds = 0.5;

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Where a film has no samples yet, what the preview shows.
void fill_gaps(image::Picture& picture, const image::Picture& preview)
{
    const auto counts = std::ranges::find(picture.layers, "sample_count", &image::Layer::name);
    if (counts == picture.layers.end()) return;
    const std::vector<uint32_t> samples = counts->ids;
    for (image::Layer& layer : picture.layers) {
        const auto from = std::ranges::find(preview.layers, layer.name, &image::Layer::name);
        if (from == preview.layers.end()) continue;
        const auto fill = [&](auto& to, const auto& other) {
            const size_t channels = to.size() / samples.size();
            for (size_t k = 0; k < to.size() && k < other.size(); ++k)
                if (samples[k / channels] == 0) to[k] = other[k];
        };
        fill(layer.pixels, from->pixels);
        fill(layer.ids, from->ids);
    }
}

}  // namespace

LiveRender::LiveRender(LiveScene& scene, MakeBackend make_backend, LiveHooks hooks,
                       RenderOptions aims)
    : scene_(scene), make_backend_(std::move(make_backend)), hooks_(std::move(hooks)),
      aims_(std::move(aims)), backend_(make_backend_())
{
    backend_->upload(scene_.data());
    hooks_.watch_files(scene_.files(), scene_.read_at());
}

void LiveRender::run()
{
    tell_news();
    while (!is_over_) {
        stop_ = false;
        render_once();
        while (!stop_) serve(idle_seconds);
    }
}

// A sample a pixel for a first picture, then the picture that `diptych render` would make.
void LiveRender::render_once()
{
    preview_ = {};
    old_backends_.clear();
    old_scenes_.clear();
    dispatched_ = asked_ = Clock::now();
    for (const bool is_preview : {true, false}) {
        if (stop_ || (is_preview && aims_.samples == 1)) continue;
        RenderOptions options;
        if (!is_preview)
            options = aims_;
        else
            options.samples = 1;
        options.stop = &stop_;
        options.stops_at_once = true;
        options.most_items = most_items_;
        options.observe = [&](const RenderState& state) {
            after_dispatch(state.film, is_preview);
            options.most_items = most_items_;
        };
        const RenderResult result = render(*backend_, scene_.data(), options);
        if (is_preview) preview_ = result.film.picture();
        const bool is_complete = result.is_complete && !is_preview;
        if (!stop_ || is_over_ || is_complete) show(result.film, is_complete ? &result : nullptr);
    }
}

void LiveRender::after_dispatch(const Film& film, bool is_preview)
{
    if (!edit_.empty()) {
        last_latency_ = seconds_since(edited_);
        hooks_.tell(
            fmt::format("{}; first new sample after {:.0f} ms", edit_, 1000 * last_latency_));
        edit_.clear();
    }
    const double seconds = seconds_since(dispatched_);
    if (!is_preview)  // how much the next render takes at once
        most_items_ = std::clamp(int(most_items_ * dispatch_seconds / std::max(seconds, 1e-4)),
                                 std::max(1, most_items_ / 2), std::min(2 * most_items_, 1024));
    if (!is_preview && seconds_since(shown_) > std::max(show_every, show_seconds_ / show_share))
        show(film, nullptr);
    serve(0);
    dispatched_ = Clock::now();
}

void LiveRender::show(const Film& film, const RenderResult* end)
{
    const auto start = Clock::now();
    image::Picture picture = picture_of(film, aims_.viewer);
    fill_gaps(picture, preview_);
    hooks_.show(picture, scene_, *backend_, end);
    shown_ = Clock::now();
    show_seconds_ = seconds_since(start);
}

void LiveRender::serve(double wait_seconds)
{
    const bool waits = wait_seconds > 0 && !held_.empty();
    Requests requests = hooks_.requests(waits ? hold_seconds : wait_seconds);
    if (wait_seconds == 0) requests.since -= Clock::now() - asked_;  // it came at the earliest then
    asked_ = Clock::now();
    apply(requests);
    if (!held_.empty() && (requests.is_over || seconds_since(held_since_) > hold_seconds))
        tell_held_message();
    if (requests.is_over) is_over_ = stop_ = true;
}

void LiveRender::apply(const Requests& requests)
{
    for (const std::string& value : requests.values) {
        try {
            const Edit edit = scene_.set_value(value);
            follow(edit);
            begin_again(edit, requests.since);
            if (edit.kind != EditKind::scene) continue;
            held_.clear();  // the files were read anew
            has_told_error_ = false;
            hooks_.watch_files(scene_.files(), scene_.read_at());
        } catch (const std::runtime_error& error) {
            warn(error.what());
        }
    }
    if (requests.changed.empty()) return;
    try {
        const Edit edit = scene_.look_again(requests.changed);
        follow(edit);
        held_.clear();
        if (std::exchange(has_told_error_, false) && edit.kind == EditKind::nothing)
            hooks_.tell("the error is gone; the picture goes on");
        begin_again(edit, requests.since);
    } catch (const std::runtime_error& error) {
        hold(error.what());
    }
    hooks_.watch_files(scene_.files(), scene_.read_at());
}

// Brings the edit to the device; if that fails, neither the scene nor the device has changed.
void LiveRender::follow(const Edit& edit)
{
    try {
        if (edit.kind == EditKind::scene) {
            std::unique_ptr<Backend> fresh = make_backend_();
            fresh->upload(scene_.data());
            old_backends_.push_back(std::move(backend_));
            backend_ = std::move(fresh);
        }
        if (edit.kind == EditKind::textures) backend_->update_textures(scene_.data());
        if (edit.kind == EditKind::textures || edit.kind == EditKind::arguments)
            backend_->update_materials(scene_.data());
    } catch (...) {
        scene_.undo();
        throw;
    }
    old_scenes_.push_back(scene_.accept());
}

void LiveRender::begin_again(const Edit& edit, Clock::time_point since)
{
    for (const std::string& line : edit.warnings) hooks_.tell("notice: " + line);
    tell_news();
    if (edit.kind == EditKind::nothing) return;
    stop_ = true;
    if (edit_.empty()) edited_ = since;
    edit_ = edit.what;
    if (edit.kind == EditKind::arguments) edit_ += ": nothing to compile";
    if (edit.kind == EditKind::textures) edit_ += ": texture stage made anew";
}

void LiveRender::tell_news()
{
    std::vector<std::string> notices = hooks_.notices(scene_.data());
    for (const std::string& line : notices)
        if (std::ranges::find(notices_, line) == notices_.end()) hooks_.tell("notice: " + line);
    notices_ = std::move(notices);
}

void LiveRender::warn(const std::string& message)
{
    hooks_.warn(message);
    for (const std::string& value : scene_.waiting())
        hooks_.tell(printable(value) + " waits for a save that is taken");
}

void LiveRender::hold(const std::string& message)
{
    if (held_.empty()) held_since_ = Clock::now();
    held_ = message;
}

void LiveRender::tell_held_message()
{
    warn(held_);
    has_told_error_ = true;
    held_.clear();
}

}  // namespace diptych
