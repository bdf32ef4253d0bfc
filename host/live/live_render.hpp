// A render that goes on while its scene is edited: after each dispatch it looks for edits, brings
// them to the device, and begins the picture again.
#pragma once

#include "backends/backend.hpp"
#include "host/live/live_scene.hpp"
#include "host/render/render.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace diptych {

// What came from outside since the last time.
struct Requests {
    std::vector<std::filesystem::path> changed;   // of LiveScene::files()
    std::vector<std::string> values;              // "NODE.ARGUMENT=JSON"
    bool is_over = false;                         // end, with the picture as it is
    std::chrono::steady_clock::time_point since;  // when the first of them was noticed
};

struct LiveHooks {
    // Asked after every dispatch with 0, and with seconds to wait when there is nothing to render.
    std::function<Requests(double wait_seconds)> requests;
    // The files to watch are others now; the scene was read at that time.
    std::function<void(const std::vector<std::filesystem::path>&, std::filesystem::file_time_type)>
        watch_files;
    // A picture worth showing; `end`: how its render ended, nullptr while it goes on.
    std::function<void(const image::Picture&, const LiveScene&, const Backend&,
                       const RenderResult* end)>
        show;
    // What there is to say of the scene as it is by now: each line is told when it is new.
    std::function<std::vector<std::string>(const SceneData&)> notices;
    std::function<void(const std::string&)> tell;  // a line: what an edit did, how long it took
    std::function<void(const std::string&)> warn;  // the message of an edit that failed
};

class LiveRender {
public:
    using MakeBackend = std::function<std::unique_ptr<Backend>()>;

    // aims: samples, error, time and viewer of each picture. Uploads the scene. Throws what the
    // backend does.
    LiveRender(LiveScene& scene, MakeBackend make_backend, LiveHooks hooks, RenderOptions aims);

    // Until a request is_over; the last picture has been shown then.
    void run();

    const Backend& backend() const { return *backend_; }
    double last_latency() const { return last_latency_; }  // seconds: an edit to its first sample

private:
    using Clock = std::chrono::steady_clock;

    void render_once();
    void after_dispatch(const Film& film, bool is_preview);
    void serve(double wait_seconds);
    void apply(const Requests& requests);
    void follow(const Edit& edit);
    void tell_news();
    void warn(const std::string& message);
    void hold(const std::string& message);
    void tell_held_message();
    void show(const Film& film, const RenderResult* end);
    void begin_again(const Edit& edit, Clock::time_point since);

    LiveScene& scene_;
    MakeBackend make_backend_;
    LiveHooks hooks_;
    RenderOptions aims_;
    std::unique_ptr<Backend> backend_;
    // What the render under way still uses, after all of its scene was loaded anew.
    std::vector<std::unique_ptr<SceneData>> old_scenes_;
    std::vector<std::unique_ptr<Backend>> old_backends_;

    std::atomic<bool> stop_{false};
    bool is_over_ = false;
    image::Picture preview_;  // one sample a pixel
    int most_items_ = 8;      // in a dispatch
    Clock::time_point dispatched_;
    Clock::time_point shown_;
    double show_seconds_ = 0;
    std::vector<std::string> notices_;  // as they were last told
    std::string edit_;                  // that waits for its first sample
    Clock::time_point edited_;
    Clock::time_point asked_;  // when edits were last looked for
    double last_latency_ = 0;
    std::string held_;  // an error that the rest of a save may still settle
    Clock::time_point held_since_;
    bool has_told_error_ = false;  // and nothing was taken since
};

}  // namespace diptych
