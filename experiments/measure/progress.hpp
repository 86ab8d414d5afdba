// Tells how a run gets on: to the terminal, and to log.txt with times.
//
//     Progress progress(Progress::Mode::automatic);
//     progress.log_to(folder / "log.txt");
//     progress.step("city  bvh default", 3, 40);     // one line that updates itself on a terminal
//     progress.note("2 degenerate triangles left out");
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace experiments::measure {

class Progress {
  public:
    enum class Mode { automatic, quiet };
    explicit Progress(Mode mode);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Appends to `file` from now on; a log that cannot be written is no error.
    void log_to(const std::filesystem::path& file);
    /// `done` of `total` steps are finished and `what` comes next.
    void step(const std::string& what, int done, int total);
    /// How far the step under way has got: a few times a second on a terminal, now and then
    /// elsewhere, never in the log.
    void update(const std::string& what);
    /// A line that stays.
    void note(const std::string& text);
    /// The same for something that went wrong: shown even when quiet.
    void error(const std::string& text);
    /// To the log alone.
    void log_error(const std::string& text) { log("error: " + text); }
    /// Removes the updating line.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;

    void log(const std::string& text);
    void show(const std::string& what);

    Mode mode_;
    bool terminal_ = false;
    bool line_shown_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point shown_ = begin_;  ///< when something was last written
    std::string steps_;                 ///< "[3/40]" of the step under way
    std::ofstream log_;
};

}  // namespace experiments::measure
