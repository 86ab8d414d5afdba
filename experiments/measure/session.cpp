#include "experiments/measure/session.hpp"

#include <algorithm>
#include <new>

namespace experiments::measure {

bool Session::attempt(const std::string& place, const std::function<void()>& work) {
    std::string message;
    try {
        work();
        return true;
    } catch (const OutputError&) {
        throw;
    } catch (const taskpool::gpu::Error& error) {
        if (error.result == VK_ERROR_DEVICE_LOST) throw;
        message = error.what();
    } catch (const std::bad_alloc&) {
        message = "memory does not suffice; use a smaller scene or resolution";
    } catch (const std::exception& error) {
        message = error.what();
    }
    std::replace(message.begin(), message.end(), '\n', ' ');
    fail(place + ": " + message);
    return false;
}

void Session::attempt_scenes(const std::function<void(const config::Scene&)>& work) {
    steps_total = 0;
    for (const config::Scene& scene : config.scenes) steps_total += steps_of(scene);
    int steps = 0;
    for (const config::Scene& scene : config.scenes) {
        steps_done = steps;
        steps += steps_of(scene);
        // What fails in a frame stays out of the later ones: the last says that all are complete.
        if (!samples.complete({scene.name, kSceneRows, "", scene.frames() - 1, 0}))
            attempt(scene.name, [&] { work(scene); });
    }
}

void Session::fail(const std::string& message) {
    failures.push_back(message);
    progress.error(message);
}

}  // namespace experiments::measure
