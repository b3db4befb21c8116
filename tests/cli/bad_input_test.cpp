// SPDX-License-Identifier: Apache-2.0
// Mistakes of users and failures of disks, tried with the real program. Each must give one clear line and the
// documented exit code, and leave old pictures alone.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <utility>

#include "host/cl/devices/device_list.h"
#include "tests/cli/run_program.h"
#include "tests/support/device_required.h"
#include "tests/support/tev_port.h"

namespace nearlight::core {
namespace {

const std::string kCamera =
    "<sensor type='perspective'><float name='fov' value='60'/><transform name='to_world'>"
    "<lookat origin='0,0,-0.9' target='0,0,1' up='0,1,0'/></transform></sensor>\n";
const std::string kRoom =
    "<bsdf type='diffuse' id='white'><rgb name='reflectance' value='0.5,0.5,0.5'/></bsdf>\n"
    "<shape type='cube'><boolean name='flip_normals' value='true'/><ref id='white'/></shape>\n";
const std::string kLamp =
    "<shape type='rectangle'><transform name='to_world'><scale value='0.3'/><rotate x='1' angle='90'/>"
    "<translate y='0.95'/></transform><emitter type='area'><rgb name='radiance' "
    "value='9,9,9'/></emitter></shape>\n";
const std::string kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n";

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t result = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++result;
    }
    return result;
}

class BadInput : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    std::filesystem::path write_scene(const std::string& body) const {
        return write("scene.xml", "<scene version='3.0.0'>\n" + kCamera + body + "</scene>\n");
    }
    std::filesystem::path good_scene() const { return write_scene(kRoom + kLamp); }
    [[nodiscard]] std::filesystem::path picture() const { return folder_ / "picture.png"; }

    /// Renders over an old picture. The new one is small unless `more` has another size. `before` stands in
    /// front of the program, as in `VAR=value`.
    ProgramResult render(const std::filesystem::path& scene, const std::string& more = "",
                         const std::string& before = "") {
        write("picture.png", "old");
        std::string arguments = "render " + quoted(scene) + " -o " + quoted(picture()) + " " + more;
        for (const auto& [option, value] :
             {std::pair{"--size", " 16x16"}, {"--spp", " 1"}, {"--vpls", " 16"}}) {
            arguments += contains(more, option) ? "" : std::string(" ") + option + value;
        }
        return run_program(arguments, before);
    }
    void expect_error(const ProgramResult& result, int exit_code, const std::string& part) const {
        EXPECT_EQ(result.exit_code, exit_code) << result.errors;
        EXPECT_EQ(result.output, "");
        EXPECT_EQ(count(result.errors, "nearlight: error: "), 1u) << result.errors;
        EXPECT_TRUE(contains(result.errors, part)) << result.errors;
        EXPECT_EQ(file_text(picture()), "old");
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
            EXPECT_FALSE(contains(entry.path().string(), ".partial")) << entry.path();
        }
    }
    void expect_picture(const ProgramResult& result, const std::string& warning) const {
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_EQ(count(result.errors, warning), 1u) << result.errors;
        EXPECT_TRUE(file_text(picture()).starts_with("\x89PNG"));
    }
    TemporaryFolder folder_;
};

TEST_F(BadInput, NobodyListensWhereTevShould) {
    expect_error(render(good_scene(), "--tev localhost"), 1, "start tev first");
    expect_error(render(good_scene(), "--tev :14158"), 2, "HOST:PORT");
}

/// The errors that need a device.
class BadInputOnDevice : public BadInput {
  protected:
    void SetUp() override { NEARLIGHT_NEEDS_DEVICE(); }
};

/// A tev that accepts the connection and never reads, which cannot hold 20 MB.
TEST_F(BadInputOnDevice, ATevThatDoesNotRead) {
    const test::TevPort port;
    expect_picture(
        render(good_scene(), "--size 512x512 --tev " + port.address()),
        "(it has not read for 2 s); the picture is not sent to it any more, and the render goes on");
}

TEST_F(BadInput, BrokenXml) {
    expect_error(render(folder_ / "missing.xml"), 3, "no such scene file");
    expect_error(render(write("empty.xml", "")), 3, "empty.xml:1: broken XML");
    expect_error(render(write("cut.xml", "<scene version='3.0.0'>\n<shape type='cu")), 3,
                 "cut.xml:2: broken XML");
    expect_error(render(write("tags.xml", "<scene version='3.0.0'><shape></scene>")), 3,
                 "tags.xml:1: broken XML");
    expect_error(render(write_scene("<shape type='nosuch'/>\n")), 3, "scene.xml:3: unknown shape 'nosuch'");
    expect_error(render(write("scene.abc", "")), 3, "unknown scene format");
    expect_error(render(folder_.path()), 3, "is a folder; give the scene file in it");
}

TEST_F(BadInput, BrokenMeshes) {
    const std::string shape = "<shape type='ply'><string name='filename' value='mesh.ply'/></shape>\n";
    expect_error(render(write_scene(shape)), 3, "mesh.ply: no such file");
    write("mesh.ply", kPlyHeader + "0 0 0\n1 0");
    expect_error(render(write_scene(shape)), 3, "truncated");
    write("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 1000000000000\nelement face 1\nend_header\n");
    expect_error(render(write_scene(shape)), 3, "promises 1000000000000 times 'vertex'");
    write("mesh.ply",
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
          "end_header\n0 0 0\n");
    expect_error(render(write_scene(shape)), 3, "mesh.ply: has no triangles");
    expect_error(render(write("bad.obj", "v 0 0 0\nf 1 2 9\n")), 3, "bad.obj:2: face refers to vertex");
}

// A name in a file could otherwise change the terminal's colours, title or contents.
TEST_F(BadInput, NothingInAFileControlsTheTerminal) {
    const std::string name = "cu&#27;[31m&#155;&#13;&#10;&#7;be";
    const ProgramResult result = render(write_scene("<shape type='" + name + "'/>\n"));
    expect_error(result, 3, "unknown shape 'cu?[31m??");
    EXPECT_EQ(count(result.errors, "\n"), 1u) << result.errors;
    const ProgramResult info = run_program(
        "info " +
        quoted(write_scene("<shape type='cube' id='a'><string name='" + name + "' value='x'/></shape>\n")));
    EXPECT_EQ(info.exit_code, 0);
    EXPECT_TRUE(contains(info.errors, "cu?[31m??")) << info.errors;
    EXPECT_EQ(count(info.errors + info.output, "\x1b"), 0u);
    EXPECT_EQ(count(info.errors, "\n"), count(info.errors, "warning: ")) << info.errors;
}

// Such a file may never end.
TEST_F(BadInput, PipesAndDevicesAreRefusedAtOnce) {
    const std::filesystem::path pipe = folder_ / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    for (const char* extension : {".xml", ".obj", ".gltf", ".glb"}) {
        const std::filesystem::path scene = folder_ / (std::string("scene") + extension);
        std::filesystem::create_symlink(pipe, scene);
        expect_error(render(scene), 3, "it is a pipe or a device, not a file");
        std::filesystem::remove(scene);
    }
    for (const char* type : {"ply", "obj", "serialized"}) {
        const std::string shape =
            std::string("<shape type='") + type + "'><string name='filename' value='pipe'/></shape>\n";
        expect_error(render(write_scene(shape)), 3, "it is a pipe or a device, not a file");
    }
    const std::string sky = "<emitter type='envmap'><string name='filename' value='/dev/zero'/></emitter>\n";
    expect_error(render(write_scene(kRoom + sky)), 3, "it is a pipe or a device, not a file");
    expect_error(run_program("diff " + quoted(pipe) + " /dev/zero"), 3,
                 "it is a pipe or a device, not a file");
}

TEST_F(BadInputOnDevice, OddMeshesAreTakenAsTheyAre) {
    const std::string shape = "<shape type='ply'><string name='filename' value='mesh.ply'/></shape>\n";
    write("mesh.ply", kPlyHeader + "0 0 0\n1 0 0\n0 1 0\nnan 0 0\n3 0 1 2\n3 1 2 3\n");
    expect_picture(render(write_scene(kRoom + kLamp + shape)), "1 triangles with NaN or infinite corners");
    write("mesh.ply", kPlyHeader + "0 0 0\n1 0 0\n2 0 0\n0 1 0\n3 0 1 2\n3 0 0 0\n");
    expect_picture(render(write_scene(kRoom + kLamp + shape)), "wrote ");
}

TEST_F(BadInputOnDevice, ScenesInWhichThereIsNothingToSee) {
    expect_picture(render(write_scene("")), "the scene has no triangles");
    expect_picture(render(write_scene(kRoom)), "nothing in the scene emits light");
    expect_picture(render(good_scene(), "--vpls 0"), "lacks the indirect light that VPLs bring");
    expect_picture(render(write_scene(kRoom + kLamp +
                                      "<shape type='cube'><transform name='to_world'>"
                                      "<scale value='0.05'/><translate z='-0.9'/></transform></shape>")),
                   "the camera sees no diffuse surface");
}

TEST_F(BadInputOnDevice, AFileIsNoCacheFolder) {
    const std::filesystem::path file = write("cache", "");
    const ProgramResult result =
        run_program("bench sort --repeats 1 --count 1000 --cache-dir " + quoted(file));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(count(result.errors, "cache' is no folder, so nothing is kept; see --cache-dir"), 1u)
        << result.errors;
}

TEST_F(BadInputOnDevice, MissingTextureIsGrey) {
    const std::string textured =
        "<bsdf type='diffuse' id='white'><texture name='reflectance' type='bitmap'>"
        "<string name='filename' value='nosuch.png'/></texture></bsdf>\n"
        "<shape type='cube'><boolean name='flip_normals' value='true'/><ref id='white'/></shape>\n";
    expect_picture(render(write_scene(textured + kLamp)), "replaced by mid-grey");
    expect_error(render(write_scene(textured + kLamp), "--strict"), 3, "nosuch.png");
    expect_error(render(write_scene(textured + kLamp), "--strict"), 3, "without --strict it is a warning");
}

/// Options that do not fit the files are no errors, because scripts give them to all files alike.
TEST_F(BadInputOnDevice, OptionsThatChangeNothing) {
    const auto scene = good_scene();
    expect_picture(render(scene, "--exr-precision float"), "no output is an EXR file");
    expect_picture(render(scene, "--exr-compression piz"), "no output is an EXR file");
    const ProgramResult result = run_program("render " + quoted(scene) + " -o " + quoted(folder_ / "a.exr") +
                                             " --exposure 1 --size 16x16 --spp 1 --vpls 16");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(contains(result.errors, "no output is a PNG file")) << result.errors;
}

TEST_F(BadInput, Options) {
    const auto scene = good_scene();
    for (const char* size : {"0x0", "-5x5", "1000000x1"}) {
        expect_error(render(scene, std::string("--size ") + size), 2, "is not a size");
    }
    expect_error(render(scene, "--spp 0"), 2, "--spp");
    expect_error(render(scene, "--vpls -3"), 2, "--vpls");
    expect_error(render(scene, "--max-depth 0"), 2, "--max-depth");
    expect_error(render(scene, "--range nan"), 2, "--range");
    expect_error(render(scene, "-D x"), 2, "NAME=VALUE");
    expect_error(render(scene, "--layers nosuch"), 2, "unknown layer 'nosuch'; choose from: ");
    expect_error(render(scene, "--layers depth"), 2, "no output is one; give -o FILE.exr");
    for (const char* sampler : {"nosuch", "7", ""}) {
        expect_error(render(scene, "--sampler '" + std::string(sampler) + "'"), 2,
                     "choose one of: bidirectional, close-range, instant-radiosity");
    }
}

TEST_F(BadInput, CamerasAndLight) {
    const auto scene = good_scene();
    expect_error(render(scene, "--camera 2"), 2, "has no camera '2'; choose one of: 1");
    expect_error(render(scene, "--origin nan,0,0"), 2, "--origin must be X,Y,Z");
    expect_error(render(scene, "--target 1,2,nan"), 2, "--target must be X,Y,Z");
    expect_error(render(scene, "--up 1,2,3,4"), 2, "--up must be X,Y,Z");
    expect_error(render(scene, "--origin 1,2"), 2, "--origin must be X,Y,Z");
    expect_error(render(scene, "--origin 1,2,3 --target 1,2,3"), 2, "its target is its origin");
    expect_error(render(scene, "--origin 0,0,0"), 2,
                 "looks at the middle of the scene, and this origin is that middle; give a target, too; see "
                 "--target");
    expect_error(render(scene, "--up 0,0,0"), 2, "its vector `up` is zero, or points where it looks");
    expect_error(render(scene, "--fov 200"), 2, "field of view");
    expect_error(render(scene, "--environment " + quoted(write("sky.exr", "text"))), 3, "sky.exr");
    expect_error(render(scene, "--environment nosuch.exr"), 3, "nosuch.exr");
    expect_error(render(scene, "--environment 1,inf,1"), 2, "must be finite");
    expect_error(render(scene, "--sun 10"), 2, "--sun must be AZIMUTH,ELEVATION");
    expect_error(render(scene, "--sun 10,-5"), 2, "elevation");
    expect_error(render(scene, "--light-scale -1"), 2, "scale of light");
    expect_error(render(scene, "--exposure bright"), 2, "--exposure must be `auto` or a number");
    expect_error(render(scene, "--tonemap aces"), 2, "unknown --tonemap 'aces'; choose one of: agx, filmic");
}

TEST_F(BadInput, OptionsWithoutEffect) {
    const auto scene = good_scene();
    expect_error(render(scene, "--sampler rejection --policy paper"), 2,
                 "--policy is for the sampler close-range, not for rejection");
    expect_error(render(scene, "--sampler local --close-fraction 0.5"), 2,
                 "--close-fraction is for the sampler close-range, not for local");
    expect_error(render(scene, "--vpls 100 --vpl-set 99"), 2, "--vpl-set 99 is smaller than --vpls 100");
}

TEST_F(BadInput, Outputs) {
    const auto scene = good_scene();
    expect_error(render(scene, "-o " + quoted(folder_ / "x.jpg")), 2,
                 "the names of pictures end in .exr or .png");
    expect_error(render(scene, "-o " + quoted(folder_ / "x")), 2,
                 "the names of pictures end in .exr or .png");
    expect_error(render(scene, "-o " + quoted(folder_ / "none" / "x.png")), 3, "there is no folder");
    std::filesystem::create_directory(folder_ / "folder.png");
    expect_error(render(scene, "-o " + quoted(folder_ / "folder.png")), 3, "it is a folder");
    if (geteuid() != 0) {  // root may write to read-only files
        std::filesystem::permissions(write("fixed.png", ""), std::filesystem::perms::owner_read);
        expect_error(render(scene, "-o " + quoted(folder_ / "fixed.png")), 3, "read-only");
    }
}

TEST_F(BadInputOnDevice, OutputThatFailsLate) {
    if (!std::filesystem::exists("/proc/self")) {
        GTEST_SKIP() << "no /proc here";
    }
    expect_error(render(good_scene(), "-o /proc/x.png"), 3, "/proc/x.png");
}

TEST_F(BadInputOnDevice, StandardStreamsMayBeClosed) {
    for (const char* closed : {"2>&-", "<&- 2>&-", "2>&1 | true", "2>/dev/full"}) {
        write("picture.png", "old");
        run_program("render " + quoted(good_scene()) + " --size 16x16 --spp 1 --vpls 16 -o " +
                    quoted(picture()) + " " + closed);
        EXPECT_TRUE(file_text(picture()).starts_with("\x89PNG")) << closed;
    }
}

TEST_F(BadInputOnDevice, HomeMayBeNoFolder) {
    const auto file = write("home", "");
    const auto temporary = folder_ / "temporary";
    std::filesystem::create_directory(temporary);
    const ProgramResult result = render(
        good_scene(), "",
        "env -u XDG_CACHE_HOME -u POCL_CACHE_DIR TMPDIR=" + quoted(temporary) + " HOME=" + quoted(file));
    expect_picture(result, "cannot be written, so that PoCL keeps nothing that it compiled");
    EXPECT_TRUE(std::filesystem::is_empty(temporary));
}

TEST_F(BadInput, NoDevice) {
    const auto scene = good_scene();
    expect_error(render(scene, "", "OCL_ICD_VENDORS=/nonexistent"), 4, "install a driver");
    const auto icd = write("broken.icd", "libnearlight-nosuch.so\n");
    expect_error(render(scene, "", "OCL_ICD_VENDORS=" + quoted(icd.parent_path())), 4, "install a driver");
}

TEST_F(BadInputOnDevice, UnknownDevice) {
    expect_error(render(good_scene(), "--device nosuch"), 4, "there are: 0 = ");
    expect_error(render(good_scene(), "--device 99"), 4, "there are: 0 = ");
}

TEST_F(BadInputOnDevice, BrokenKernel) {
    const auto kernels = folder_ / "kernels";
    std::filesystem::copy(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "kernels", kernels,
                          std::filesystem::copy_options::recursive);
    std::ofstream(kernels / "film.cl", std::ios::app) << "kernel void broken( {\n";
    expect_error(render(good_scene(), "--kernel-dir " + quoted(kernels)), 5, "film.cl:");
    expect_error(render(good_scene(), "--kernel-dir " + quoted(folder_ / "none")), 5, "check --kernel-dir");
}

TEST_F(BadInputOnDevice, MoreThanMemoryHolds) {
    expect_error(render(good_scene(), "--size 65536x65536"), 6, "1024 million; use a smaller --size\n");
    // This is one GiB, which a device that is not PoCL's may have.
    const ProgramResult result =
        render(good_scene(), "--vpls 4000000 --direct-samples 1", "POCL_MEMORY_LIMIT=1");
    if (result.exit_code != 0) {
        expect_error(result, 6, "use a smaller");
    }
}

TEST_F(BadInputOnDevice, InterruptBeforeTheFirstRowsKeepsTheOldPicture) {
    std::ofstream(picture()) << "an old picture";
    const ProgramResult result =
        run_interrupted("render " + quoted(good_scene()) + " -o " + quoted(picture()) +
                            " --size 2048x2048 --spp 4096 --vpls 2000",
                        1.5, [&](const ProgramResult& ended) { return ended.exit_code == 130; });
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_EQ(file_text(picture()), "an old picture");
    EXPECT_NE(result.errors.find("nothing was written"), std::string::npos) << result.errors;
}

TEST_F(BadInputOnDevice, InterruptSavesWhatIsThere) {
    const ProgramResult result =
        run_interrupted("render " + quoted(good_scene()) + " -o " + quoted(picture()) +
                            " --size 1024x1024 --spp 128 --vpls 1000 --quiet",
                        4, [&](const ProgramResult&) { return std::filesystem::exists(picture()); });
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_TRUE(file_text(picture()).starts_with("\x89PNG"));
    EXPECT_EQ(folder_.file_count(), 2u);  // the scene and the picture
}

}  // namespace
}  // namespace nearlight::core
