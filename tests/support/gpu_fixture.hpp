// One device for all tests of a program, under validation layers. A test using GpuTest fails if
// the layers had anything to say while it ran.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "taskpool/gpu/device.hpp"

namespace tests {

/// The shared device; created on first use with validation where the layer is installed.
taskpool::gpu::Device& device();
/// Validation messages since the last call.
std::vector<std::string> take_validation_messages();

class GpuTest : public testing::Test {
  protected:
    void SetUp() override { take_validation_messages(); }
    void TearDown() override {
        for (const std::string& message : take_validation_messages()) ADD_FAILURE() << message;
    }
};

}  // namespace tests
