// Keeps on disk what shadows/truth found, so that the points of a scene under a light are judged
// once.
//
//     TruthCache cache(folder, [&](const std::string& line) { progress.note(line); });
//     const std::string key = truth_key(mesh, light, points);
//     std::optional<Verdicts> known = cache.load(key, points.x.size());
//     if (!known) cache.store(key, truth.judge(points, {}));
//
// A cache that cannot be read or written costs time, never a run: each such case is one line to
// `warn`.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "shadows/truth/truth.hpp"

namespace experiments::measure {

/// SHA-256 of everything that the verdicts depend on: corners and indices of the triangles, the
/// light, the points, and a version number of the judge.
std::string truth_key(const structures::geometry::TriangleMesh& mesh,
                      const structures::geometry::Light& light, const shadows::PointArrays& points);

/// $XDG_CACHE_HOME/grove, or ~/.cache/grove; empty if the environment names neither.
std::filesystem::path default_cache_folder();

class TruthCache {
  public:
    using Warn = std::function<void(const std::string&)>;

    /// Entries are files below `folder`/truth, made when the first is stored; with an empty
    /// `folder` nothing is kept.
    TruthCache(const std::filesystem::path& folder, Warn warn);

    /// The verdicts stored under `key`, or nothing if there are none. An entry that is damaged (its
    /// length or checksum is wrong) or cannot be read is reported and counts as none.
    std::optional<shadows::truth::Verdicts> load(const std::string& key, std::size_t count) const;
    /// Replaces the entry in one step, so that other processes see the whole of it or none of it. A
    /// folder that takes no file is reported, the first time.
    void store(const std::string& key, const shadows::truth::Verdicts& verdicts);

  private:
    std::filesystem::path entry(const std::string& key) const { return folder_ / (key + ".truth"); }

    std::filesystem::path folder_;
    Warn warn_;
    bool writable_ = true;
};

}  // namespace experiments::measure
