#include "host/render/host_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;

// The number that a file of the kernel's holds; none where there is no file or no limit ("max").
size_t number_in(const fs::path& file)
{
    std::ifstream in(file);
    size_t number = 0;
    return in >> number ? number : SIZE_MAX;
}

// The least of the limits of a control group and of those around it. Version 2 has one hierarchy,
// version 1 one of its own for memory.
size_t control_group_limit()
{
    std::ifstream groups("/proc/self/cgroup");
    size_t least = SIZE_MAX;
    for (std::string line; std::getline(groups, line);) {
        const size_t names = line.find(':'), path = line.find(':', names + 1);
        if (path == std::string::npos) continue;
        const std::string controllers = line.substr(names + 1, path - names - 1);
        const bool is_second = controllers.empty();
        if (!is_second && controllers.find("memory") == std::string::npos) continue;
        const fs::path root = is_second ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
        const char* limit = is_second ? "memory.max" : "memory.limit_in_bytes";
        for (fs::path group = fs::path(line.substr(path + 1)).relative_path();;
             group = group.parent_path()) {
            least = std::min(least, number_in(root / group / limit));
            if (group.empty()) break;
        }
    }
    return least;
}

size_t less(size_t limit, size_t taken) { return limit > taken ? limit - taken : 0; }

}  // namespace

size_t host_memory_left()
{
    const auto page = size_t(sysconf(_SC_PAGESIZE));
    size_t addressed = 0, resident = 0;  // pages of this process
    std::ifstream("/proc/self/statm") >> addressed >> resident;
    const size_t machine = size_t(sysconf(_SC_PHYS_PAGES)) * page;
    size_t left = less(std::min(machine, control_group_limit()), resident * page);
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        left = std::min(left, less(size_t(limit.rlim_cur), addressed * page));
    return left;
}

}  // namespace diptych
