// Lets a shadow method of the registry answer a scene of the stress suite.
#pragma once

#include "experiments/stability/judge.hpp"
#include "shadows/method.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace tests {

inline std::unique_ptr<shadows::Method> make_method(
    const std::string& name, const std::map<std::string, structures::Value>& keys) {
    for (const shadows::MethodRow& row : shadows::registry())
        if (row.name == name)
            return row.create(device(), structures::Settings::resolve(row.parameters(), keys));
    throw std::logic_error("no shadow method " + name);
}

inline experiments::stability::Marks answer(shadows::Method& method,
                                            const experiments::stability::JudgedScene& judged) {
    const shadows::Points points(device(), judged.image.arrays, judged.image.width,
                                 judged.image.height);
    shadows::Visibility visible;
    method.prepare(judged.scene.mesh);
    method.expect(points);
    method.build(judged.scene.light);
    method.query(points, visible);
    return judged.mark(visible);
}

}  // namespace tests
