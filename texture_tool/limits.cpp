#include "texture_tool/limits.hpp"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sys/resource.h>
#include <unistd.h>

namespace texture_tool {

namespace {

char name_of_file[1024];

void say(const char* text)
{
    if (write(STDERR_FILENO, text, strlen(text)) < 0) _exit(2);
}

void end_with(const char* why)
{
    say(name_of_file);
    say(":1:1: error: ");
    say(why);
    say("\n");
    _exit(2);
}

void on_signal(int number)
{
    if (number == SIGXCPU) end_with("reading this file took more than 10 s; make it simpler");
    end_with(number == SIGSEGV || number == SIGBUS
                 ? "this file is nested too deeply for the parser; split its expressions"
                 : "reading this file took more than 1 GiB or broke the parser; make it simpler");
}

}  // namespace

void set_limits(const std::string& file)
{
    strncpy(name_of_file, file.c_str(), sizeof name_of_file - 1);
    const rlimit time{10, 12};
    setrlimit(RLIMIT_CPU, &time);
#ifndef __SANITIZE_ADDRESS__
    const rlimit memory{1u << 30, 1u << 30};
    setrlimit(RLIMIT_AS, &memory);
#endif
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    static char stack[1 << 16];
    stack_t alternative = {};
    alternative.ss_sp = stack;
    alternative.ss_size = sizeof stack;
    sigaltstack(&alternative, nullptr);
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_ONSTACK;
    for (const int number : {SIGXCPU, SIGSEGV, SIGBUS, SIGABRT, SIGILL, SIGTRAP})
        sigaction(number, &action, nullptr);
    std::set_new_handler(
        [] { end_with("reading this file took more than 1 GiB; make it simpler"); });
}

void give_up(const std::string& why)
{
    end_with(why.c_str());
    _exit(2);
}

}  // namespace texture_tool
