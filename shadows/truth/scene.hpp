// Truth's inside: what is prepared once for a mesh and a light, and the verdict on one point.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "shadows/truth/candidates.hpp"
#include "shadows/truth/exact.hpp"
#include "shadows/truth/silhouette.hpp"
#include "shadows/truth/truth.hpp"

namespace shadows::truth {

struct Truth::Scene {
    Scene(const structures::geometry::TriangleMesh& mesh, const structures::geometry::Light& light);

    Verdict judge(const glm::vec3& p, std::uint32_t own, const glm::vec3& normal,
                  Effort& effort) const;
    bool shadowed(const glm::vec3& p, std::uint32_t own) const;
    double epsilon(const glm::vec3& p) const;
    /// Throws std::invalid_argument if p is not finite or `own` no triangle; `index` names the
    /// point in the message.
    void check(const glm::vec3& p, std::uint32_t own, std::size_t index) const;

  private:
    /// A triangle that casts shadow, with all that a candidate is asked for.
    struct Caster {
        glm::vec3 corner[3];
        std::uint32_t id;
        std::int8_t side;      ///< Silhouette::side
        std::uint8_t outline;  ///< bit k: edge k has a multiplicity
    };

    Scene(const structures::geometry::TriangleMesh& mesh, const structures::geometry::Light& light,
          const std::vector<std::uint32_t>& casters);
    void find_nearest_to_light();
    Path path(const glm::vec3& p, double radius) const;
    bool occludes(const Caster& caster, const glm::vec3& p, Signs& signs) const;
    bool faces_away(const glm::vec3& p, const glm::vec3& normal) const;
    double own_outline_distance(const glm::vec3& p, std::uint32_t own, double limit) const;

    const structures::geometry::TriangleMesh& mesh_;
    structures::geometry::Light light_;
    bool directional_;
    Silhouette silhouette_;
    Candidates candidates_;
    std::vector<Caster> casters_;  ///< in the order of the candidates
    double diagonal_ = 0;          ///< of the casters' bounds
    double coordinate_ = 0;        ///< the largest of these bounds
    /// The caster nearest to a point light, and the distance of the second nearest.
    std::uint32_t nearest_ = kNoReceiver;
    double nearest_distance_ = std::numeric_limits<double>::infinity();
    double second_distance_ = std::numeric_limits<double>::infinity();
};

}  // namespace shadows::truth
