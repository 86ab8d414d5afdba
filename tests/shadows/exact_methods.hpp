// Asks shadow methods of the registry about scenes.
#pragma once

#include <map>
#include <memory>
#include <stdexcept>

#include "shadows/method.hpp"
#include "tests/shadows/exact_scenes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/points.hpp"

namespace tests {

using Keys = std::map<std::string, structures::Value>;

inline const shadows::MethodRow& find_method(const std::string& name) {
    for (const shadows::MethodRow& row : shadows::registry())
        if (row.name == name) return row;
    throw std::logic_error("no shadow method " + name);
}

inline std::unique_ptr<shadows::Method> make_method(const std::string& name, const Keys& keys) {
    const shadows::MethodRow& row = find_method(name);
    return row.create(device(), structures::Settings::resolve(row.parameters(), keys));
}

/// The value of the first sample of `metric`; fails the test if there is none.
inline double sample(const structures::Samples& samples, std::string_view metric) {
    for (const structures::Sample& one : samples)
        if (one.metric == metric) return one.value;
    ADD_FAILURE() << "no sample " << metric;
    return 0;
}

/// All of it: prepare, build, query. Fails the test if points stay without an answer.
inline shadows::Visibility answer(shadows::Method& method, const TriangleMesh& mesh,
                                  const Light& light, const shadows::Points& points) {
    method.prepare(mesh);
    method.build(light);
    shadows::Visibility visible;
    EXPECT_EQ(sample(method.query(points, visible), "incomplete"), 0);
    return visible;
}

inline shadows::Visibility answer(shadows::Method& method, const ExactScene& scene) {
    return answer(method, scene.mesh, scene.light,
                  shadows::Points(device(), scene.points, scene.width, scene.height));
}

}  // namespace tests
