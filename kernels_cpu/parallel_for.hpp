// A loop on several threads: oneTBB's; but plain threads under the thread sanitizer, which cannot
// see how a library that is not built for it synchronises, and would report every loop as a race.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>
#include <vector>

namespace diptych {

#ifdef __SANITIZE_THREAD__

// Calls body(i) once for each i in [0, count), in no order, on at most `threads` threads (0: as
// many as the machine has). Returns when all are done; what a body throws is thrown here.
template<typename Body>
void parallel_for(int threads, int count, const Body& body)
{
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int i = next++; i < count; i = next++) body(i);
    };
    const int machine = std::max(2, int(std::thread::hardware_concurrency()));
    std::vector<std::future<void>> workers;
    for (int i = std::min(count, threads > 0 ? threads : machine); i > 0; --i) {
        workers.push_back(std::async(std::launch::async, work));
    }
    for (std::future<void>& worker : workers) worker.get();
}

#else

// Calls body(i) once for each i in [0, count), in no order, on at most `threads` threads (0: as
// many as the machine has). Returns when all are done; what a body throws is thrown here.
template<typename Body>
void parallel_for(int threads, int count, const Body& body)
{
    tbb::task_arena arena(threads > 0 ? threads : int(tbb::task_arena::automatic));
    arena.execute([&] { tbb::parallel_for(0, count, body, tbb::simple_partitioner()); });
}

#endif

}  // namespace diptych
