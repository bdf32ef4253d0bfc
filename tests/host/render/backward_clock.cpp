// Loaded before the C library: a time of day that goes back by an hour whenever it is asked for.
#include <atomic>
#include <ctime>
#include <dlfcn.h>
#include <sys/time.h>

namespace {

std::time_t earlier_and_earlier()
{
    static std::atomic<std::time_t> now = 0;
    return now -= 3600;
}

}  // namespace

extern "C" {

std::time_t time(std::time_t* result)
{
    const std::time_t now = earlier_and_earlier();
    if (result) *result = now;
    return now;
}

int gettimeofday(timeval* result, void*)
{
    *result = {earlier_and_earlier(), 0};
    return 0;
}

int clock_gettime(clockid_t clock, timespec* result)
{
    using Function = int (*)(clockid_t, timespec*);
    static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clock_gettime"));
    if (clock != CLOCK_REALTIME) return real(clock, result);
    *result = {earlier_and_earlier(), 0};
    return 0;
}
}
