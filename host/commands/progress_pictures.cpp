#include "host/commands/progress_pictures.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace diptych {
namespace {

// "tev" or "tev:HOST:PORT".
std::string address_of(const std::string& text)
{
    if (text == "tev") return "";
    if (text.starts_with("tev:")) return text.substr(4);
    throw std::runtime_error("--preview " + text + ": no such viewer; use tev or tev:HOST:PORT");
}

}  // namespace

ProgressPictures::ProgressPictures(const RenderCommand& command, const RenderOptions& options,
                                   const image::WriteOptions& write)
    : command_(command), options_(options), write_(write)
{
    if (!command.refresh.empty()) interval_ = parse_seconds("--refresh", command.refresh);
    if (!command.preview.empty()) address_of(command.preview);
}

void ProgressPictures::begin(const Settings& settings)
{
    if (!command_.preview.empty())
        viewer_.emplace(address_of(command_.preview),
                        command_.outputs.empty() ? "diptych" : command_.outputs.front(),
                        settings.width, settings.height);
}

void ProgressPictures::look_at(const Film& film)
{
    const Clock::time_point now = Clock::now();
    if (viewer_ && viewer_->is_idle() && now - last_shown_ >= std::chrono::seconds(1)) {
        viewer_->show(film.beauty());
        last_shown_ = now;
    }
    if (viewer_) let_go_unless(viewer_->go_on());
    if (interval_ <= 0 || std::chrono::duration<double>(now - last_written_).count() < interval_)
        return;
    const image::Picture picture = picture_of(film, options_.viewer);
    try {
        image::write_pictures(command_.outputs, picture, write_);
    } catch (const std::runtime_error& error) {
        if (!has_failed_)
            fmt::print(stderr, "notice: {}; rendering goes on, and it is tried again\n",
                       error.what());
        has_failed_ = true;
    }
    last_written_ = Clock::now();
}

void ProgressPictures::finish(const Film& film)
{
    if (!viewer_) return;
    viewer_->show(film.beauty());
    let_go_unless(viewer_->finish());
}

void ProgressPictures::let_go_unless(bool is_there)
{
    if (is_there) return;
    fmt::print(stderr, "notice: the viewer has gone; rendering goes on\n");
    viewer_.reset();
}

}  // namespace diptych
