// SPDX-License-Identifier: Apache-2.0
// Makes calls of OpenCL fail in a program that uses the library (failing_opencl.cpp). Each failure must be an
// Error, after which the session, or at worst a new one, makes the same picture as before.
#include <CL/cl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nearlight/nearlight.h"
#include "tests/faults/failing_opencl.h"
#include "tests/support/face_device_fixture.h"

namespace nearlight {
namespace {

const std::filesystem::path kFloor = std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "tests/install/floor.xml";

class LibraryFaults : public test::FaceDeviceTest {
  protected:
    void TearDown() override { nearlight_fault(0, 0); }

    static RenderSettings settings() {
        RenderSettings settings;
        settings.view.width = 16;
        settings.view.height = 16;
        settings.view.max_depth = 3;  // on a lone floor, light of more bounces costs many walks
        settings.gather.samples_per_pixel = 1;
        settings.sampling.vpl_count = 16;
        return settings;
    }
    static std::vector<float> picture(Session& session) { return session.render(settings()).image.values; }
    /// The step with which the calls of a run are tried, so that there are about `wanted` of them.
    static long step(long calls, long wanted) {
        const char* const wish = std::getenv("NEARLIGHT_FAULTS");
        return wish != nullptr && std::string(wish) == "all" ? 1 : std::max(calls / wanted, 1L);
    }
    /// What `action` throws, or nothing.
    template <typename Action>
    static std::optional<Error> thrown_by(const Action& action) {
        try {
            action();
        } catch (const Error& error) {
            return error;
        }
        return std::nullopt;
    }
};

TEST_F(LibraryFaults, ASessionGoesOnAfterACallFailed) {
    Session session(Devices::choose(), Scene::load(kFloor));
    const std::vector<float> right = picture(session);
    nearlight_fault(0, 0);
    ASSERT_EQ(picture(session), right);
    const long calls = nearlight_fault_calls();
    ASSERT_GT(calls, 500) << "the library does not count the calls";
    long errors = 0;
    for (long call = 1; call <= calls; call += step(calls, 300)) {
        for (const int code : {CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES}) {
            nearlight_fault(call, code);
            std::vector<float> values;
            const auto error = thrown_by([&] { values = picture(session); });
            if (error) {
                ++errors;
                EXPECT_EQ(error->kind(),
                          code == CL_OUT_OF_RESOURCES ? ErrorKind::failure : ErrorKind::out_of_memory)
                    << call << ": " << error->what();
            } else {
                EXPECT_EQ(values, right) << call;
            }
            nearlight_fault(0, 0);
            ASSERT_EQ(picture(session), right) << "after call " << call << (error ? error->what() : "");
        }
    }
    EXPECT_GT(errors, 300);
}

TEST_F(LibraryFaults, ASessionThatCannotBeMadeCanBeMadeLater) {
    const Scene scene = Scene::load(kFloor);
    nearlight_fault(0, 0);
    std::vector<float> right;
    {
        Session session(Devices::choose(), scene);
        right = picture(session);
    }
    const long calls = nearlight_fault_calls();
    for (long call = 1; call <= calls; call += step(calls, 25)) {
        nearlight_fault(call, CL_MEM_OBJECT_ALLOCATION_FAILURE);
        std::vector<float> values;
        const auto error = thrown_by([&] {
            Session session(Devices::choose(), scene);
            values = picture(session);
        });
        if (error) {
            EXPECT_TRUE(error->kind() == ErrorKind::out_of_memory || error->kind() == ErrorKind::no_device)
                << call << ": " << error->what();
        } else {
            EXPECT_EQ(values, right) << call;
        }
    }
    nearlight_fault(0, 0);
    Session session(Devices::choose(), scene);
    EXPECT_EQ(picture(session), right);
}

}  // namespace
}  // namespace nearlight
