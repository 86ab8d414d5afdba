#include "experiments/measure/progress.hpp"

#include <fmt/chrono.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>

namespace experiments::measure {

Progress::Progress(Mode mode) : mode_(mode), terminal_(::isatty(STDERR_FILENO) == 1) {}

void Progress::log_to(const std::filesystem::path& file) {
    log_.close();
    log_.clear();
    log_.open(file, std::ios::app);
}

void Progress::step(const std::string& what, int done, int total) {
    steps_ = fmt::format("[{}/{}]", done, total);
    log(steps_ + " " + what);
    show(what);
}

void Progress::update(const std::string& what) {
    const std::chrono::milliseconds pause(terminal_ ? 200 : 10000);
    if (Clock::now() - shown_ >= pause) show(what);
}

void Progress::show(const std::string& what) {
    if (mode_ == Mode::quiet) return;
    shown_ = Clock::now();
    const double seconds = std::chrono::duration<double>(shown_ - begin_).count();
    if (terminal_) {
        fmt::print(stderr, "\r\033[K{} {:.0f} s  {:.90}", steps_, seconds, what);
        line_shown_ = true;
    } else {
        fmt::print(stderr, "{} {:.0f} s  {}\n", steps_, seconds, what);
    }
    std::fflush(stderr);
}

void Progress::note(const std::string& text) {
    log(text);
    if (mode_ == Mode::quiet) return;
    clear();
    fmt::print(stderr, "{}\n", text);
}

void Progress::error(const std::string& text) {
    log("error: " + text);
    clear();
    fmt::print(stderr, "grove: error: {}\n", text);
}

void Progress::clear() {
    if (line_shown_) fmt::print(stderr, "\r\033[K");
    line_shown_ = false;
}

void Progress::log(const std::string& text) {
    if (!log_.is_open()) return;
    log_ << fmt::format("{:%Y-%m-%dT%H:%M:%SZ} {}", fmt::gmtime(std::time(nullptr)), text)
         << std::endl;
}

}  // namespace experiments::measure
