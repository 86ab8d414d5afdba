#include "experiments/measure/scene_input.hpp"

#include "experiments/scenes/generators.hpp"

namespace experiments::measure {

SceneInput load_scene(const config::Scene& scene) {
    SceneInput input;
    scenes::View view;
    if (scene.generator.empty()) {
        scenes::LoadedMesh loaded = scenes::load_mesh(scene.file);
        input.mesh = std::move(loaded.mesh);
        input.report = loaded.report;
        view = scenes::default_view(input.mesh.bounds());
    } else {
        scenes::GeneratedScene generated =
            config::find_row(scenes::generators(), scene.generator).generate(scene.settings);
        input.mesh = std::move(generated.mesh);
        input.report = scenes::count(input.mesh);
        view = {generated.camera, generated.light};
    }
    input.camera = scene.camera.value_or(view.camera);
    input.light = scene.light.value_or(view.light);
    return input;
}

}  // namespace experiments::measure
