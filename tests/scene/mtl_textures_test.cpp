// SPDX-License-Identifier: Apache-2.0
// The textures of material libraries.
#include "host/image/image.h"
#include "host/image/image_io.h"
#include "host/scene/file_text.h"
#include "host/scene/texture.h"
#include "tests/scene/obj_text.h"

namespace nearlight::core {
namespace {

using namespace test;

class ObjTextures : public testing::Test {
  protected:
    /// The only material of a triangle with this entry, below any mask and side.
    Material load(const std::string& entry) {
        files_.write("m.mtl", "newmtl m\nillum 1\n" + entry);
        scene_ =
            load_obj(files_, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
        return scene_.materials[scene_.triangles.at(0).material];
    }
    [[nodiscard]] Texture texture(const Parameter& parameter) const {
        return scene_.textures.at(static_cast<std::size_t>(parameter.texture)).parameters;
    }
    Image write_image(const std::string& name, const std::vector<std::string>& channels,
                      const std::vector<float>& pixel) {
        Image image{1, 1, channels, pixel};
        nearlight::core::write_image(files_.path(name), image);
        return image;
    }

    SceneFiles files_;
    Scene scene_;
};

TEST_F(ObjTextures, ColoursOfOneNumberAreGrey) {
    const Material two_sided = load("Kd .4\n");
    expect_near(scene_.materials[two_sided.child[0]].reflectance.value, {0.4f, 0.4f, 0.4f});
}

TEST_F(ObjTextures, TheOptionOfColourCorrectionIsNoPartOfTheName) {
    write_image("a.exr", {"R", "G", "B"}, {0.5f, 0.25f, 0.125f});
    const Material two_sided = load("map_Kd -cc on a.exr\n");
    EXPECT_GE(scene_.materials[two_sided.child[0]].reflectance.texture, 0);
}

TEST_F(ObjTextures, OptionsPlaceThem) {
    write_image("a.exr", {"R", "G", "B"}, {0.5f, 0.25f, 0.125f});
    const Material two_sided = load("map_Kd -s 4 2 1 -o 0.5 0.25 0 -clamp on a.exr\n");
    const Texture placed = texture(scene_.materials[two_sided.child[0]].reflectance);
    EXPECT_FLOAT_EQ(placed.u_scale, 4.0f);
    EXPECT_FLOAT_EQ(placed.v_scale, 2.0f);
    EXPECT_FLOAT_EQ(placed.u_offset, 0.5f);
    EXPECT_FLOAT_EQ(placed.v_offset, 0.25f);
    EXPECT_EQ(placed.wrap_s, static_cast<uint>(NEARLIGHT_WRAP_CLAMP));
    EXPECT_TRUE(scene_.notes.empty() || !has_note(scene_, "-mm"));
    load("map_Kd -mm 0.1 2 a.exr\n");
    EXPECT_TRUE(has_note(scene_, "m.mtl:3: -mm and -t"));
}

TEST_F(ObjTextures, OptionsMayHaveOneOrTwoNumbers) {
    write_image("a.exr", {"R", "G", "B"}, {0.5f, 0.25f, 0.125f});
    const auto placed = [&](const std::string& options) {
        const Material two_sided = load("Kd 0.5 0.5 0.5\nmap_Kd " + options + " a.exr\n");
        return texture(scene_.materials[two_sided.child[0]].reflectance);
    };
    EXPECT_FLOAT_EQ(placed("-s 2 3").v_scale, 3.0f);
    EXPECT_FLOAT_EQ(placed("-s 2").u_scale, 2.0f);
    EXPECT_FLOAT_EQ(placed("-s 2").v_scale, 1.0f);
    EXPECT_FLOAT_EQ(placed("-o 0.25 -s 4 2").u_offset, 0.25f);
    EXPECT_FLOAT_EQ(placed("-o 0.25 -s 4 2").v_offset, 0.0f);
}

/// What tinyobjloader assumes where Kd is missing depends on the entries before.
TEST_F(ObjTextures, WithoutKdATextureIsTheColour) {
    write_image("a.exr", {"R", "G", "B"}, {0.5f, 0.25f, 0.125f});
    const Material two_sided = load("map_Kd a.exr\n");
    expect_near(scene_.materials[two_sided.child[0]].reflectance.value, {1, 1, 1});
}

TEST_F(ObjTextures, ATransparencyOfOneIsMeantAsAnOpacity) {
    EXPECT_EQ(load("Kd 1 1 1\nTr 1\n").model, NEARLIGHT_BSDF_TWO_SIDED);
    EXPECT_TRUE(has_note(scene_, "m.mtl:1: a transparency (Tr) of 1"));
    EXPECT_EQ(load("Kd 1 1 1\nTr 0.25\n").model, NEARLIGHT_BSDF_MASK);
    EXPECT_EQ(load("Kd 1 1 1\nd 0\n").model, NEARLIGHT_BSDF_MASK);
}

TEST_F(ObjTextures, OpacityIsTheAlphaOfImagesThatHaveSome) {
    write_image("leaf.exr", {"R", "G", "B", "A"}, {0.1f, 0.6f, 0.1f, 0.25f});
    write_image("grey.exr", {"R", "G", "B", "A"}, {0.75f, 0.75f, 0.75f, 1.0f});
    const auto opacity = [&](const std::string& entry) {
        const Material mask = load(entry);
        EXPECT_EQ(mask.model, NEARLIGHT_BSDF_MASK);
        return parameter_value(scene_, mask.reflectance, 0, 0).x;
    };
    EXPECT_NEAR(opacity("map_d leaf.exr\n"), 0.25f, 1e-3f);
    EXPECT_NEAR(opacity("map_d grey.exr\n"), 0.75f, 1e-3f);
    EXPECT_NEAR(opacity("map_d -imfchan g leaf.exr\n"), 0.6f, 1e-3f);
}

TEST_F(ObjTextures, TransparencyIsOneMinusAnOpacity) {
    write_image("grey.exr", {"R", "G", "B"}, {0.25f, 0.25f, 0.25f});
    write_image("colors.exr", {"R", "G", "B"}, {0.25f, 0.5f, 1.0f});
    const auto opacity = [&](const std::string& entry) {
        const Material mask = load(entry);
        EXPECT_EQ(mask.model, NEARLIGHT_BSDF_MASK);
        return parameter_value(scene_, mask.reflectance, 0, 0).x;
    };
    EXPECT_NEAR(opacity("map_Tr grey.exr\n"), 0.75f, 1e-3f);
    EXPECT_TRUE(has_note(scene_, "m.mtl:1: a texture of the transparency (map_Tr)"));
    EXPECT_NEAR(opacity("MAP_TR\t-s 2 2 -imfchan g colors.exr\n"), 0.5f, 1e-3f);
    EXPECT_NEAR(opacity("map_Tr colors.exr\nmap_d grey.exr\n"), 0.25f, 1e-3f);
    EXPECT_FALSE(has_note(scene_, "map_Tr"));
}

TEST_F(ObjTextures, MayBeNamedAsOnAnotherComputer) {
    files_.write("maps/readme", "");
    write_image("maps/Wood.exr", {"R", "G", "B"}, {0.5f, 0.25f, 0.125f});
    write_image("tile.exr", {"R", "G", "B"}, {0.5f, 0.25f, 0.125f});
    for (const char* name :
         {"maps\\Wood.exr", ".\\MAPS\\wood.EXR", "C:\\Users\\me\\tile.exr", "//server/maps/Tile.EXR"}) {
        const Material two_sided = load(std::string("map_Kd ") + name + "\nmap_Ke " + name + "\n");
        EXPECT_GE(scene_.materials[two_sided.child[0]].reflectance.texture, 0) << name;
        EXPECT_GE(two_sided.emission.texture, 0) << name;
        EXPECT_FALSE(has_note(scene_, "texture is replaced")) << name;
    }
    load("map_Kd C:\\maps\\stone.exr\n");
    EXPECT_TRUE(has_note(scene_, "m.mtl:3: texture is replaced"));
}

TEST(MovedFiles, AreFoundByTheirBareNameAndInAnyCase) {
    const SceneFiles files;
    for (const char* name : {"maps/Wood.jpg", "maps/wood.JPG", "Maps/stone.jpg", "Sky/Blue.png", "blue.png",
                             "tile.png", "Tile.png"}) {
        files.write(name, "");
    }
    const auto expect_found = [&](const std::string& name, const char* wanted) {
        const std::filesystem::path found = find_moved_file(files.path("m.mtl"), name);
        EXPECT_EQ(found.lexically_normal().string(), files.path(wanted).lexically_normal().string()) << name;
    };
    expect_found("maps/wood.JPG", "maps/wood.JPG");
    expect_found("maps\\wood.JPG", "maps/wood.JPG");
    expect_found("C:\\Users\\me\\maps\\tile.png", "tile.png");
    expect_found("/home/me/maps/tile.png", "tile.png");
    expect_found("MAPS/WOOD.JPG", "maps/Wood.jpg");  // the first of two
    expect_found("Maps/Wood.jpg", "maps/Wood.jpg");  // the folder of that very name has no such file
    expect_found("maps/stone.jpg", "Maps/stone.jpg");
    expect_found("sky/blue.png", "blue.png");
    expect_found("sky/BLUE.png", "Sky/Blue.png");
    expect_found("D:\\TILE.PNG", "Tile.png");
    expect_found(files.path("MAPS/STONE.jpg").string(), "Maps/stone.jpg");
    expect_found("gone.png", "gone.png");
    expect_found("maps", "maps");
    expect_found("C:\\gone.png", "C:/gone.png");
}

TEST(Obj, LibrariesMayBeNamedAsOnAnotherComputer) {
    const SceneFiles files;
    files.write("a.mtl", "newmtl a\nKd 0.1 0.1 0.1\nillum 1\n");
    files.write("My B.mtl", "newmtl b\nKd 0.2 0.2 0.2\nillum 1\n");
    files.write("B.mtl", "newmtl b\nKd 0.3 0.3 0.3\nillum 1\n");
    const auto reflectance = [&](const std::string& libraries) {
        const Scene scene =
            load_obj(files, "mtllib " + libraries + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl b\nf 1 2 3\n");
        EXPECT_FALSE(has_note(scene, "cannot be read")) << libraries;
        return front_of(scene, 0).reflectance.value.x;
    };
    EXPECT_FLOAT_EQ(reflectance("C:\\My models\\my b.MTL"), 0.2f);
    EXPECT_FLOAT_EQ(reflectance("models/B.mtl"), 0.3f);
    EXPECT_FLOAT_EQ(reflectance("a.mtl b.mtl"), 0.3f);
}

TEST_F(ObjTextures, EmissionHasOne) {
    write_image("screen.exr", {"R", "G", "B"}, {3, 2, 1});
    const Material lit = load("Ke 2 2 2\nmap_Ke screen.exr\n");
    expect_near(parameter_value(scene_, lit.emission, 0, 0), {6, 4, 2}, 1e-2f);
    expect_near(parameter_value(scene_, load("map_Ke screen.exr\n").emission, 0, 0), {3, 2, 1}, 1e-2f);
    EXPECT_TRUE(is_zero(load("Kd 1 1 1\n").emission.value));
}

TEST_F(ObjTextures, MapsOfNormalsCountAndHeightsAreLeftOut) {
    write_image("normal.exr", {"R", "G", "B"}, {0.5f, 0.5f, 1.0f});
    write_image("height.exr", {"R", "G", "B"}, {0.5f, 0.5f, 0.5f});
    EXPECT_EQ(load("norm normal.exr\n").model, NEARLIGHT_BSDF_NORMAL_MAP);
    EXPECT_EQ(load("map_Bump -bm 1.0 normal.exr\n").model, NEARLIGHT_BSDF_NORMAL_MAP);
    write_image("tilted.exr", {"R", "G", "B"}, {0.6f, 0.5f, 0.9f});
    const Material flatter = load("map_Bump -bm 0.5 tilted.exr\n");
    EXPECT_NEAR(parameter_value(scene_, flatter.reflectance, 0, 0).x, 0.55f, 1e-3f);
    EXPECT_EQ(load("bump height.exr\n").model, NEARLIGHT_BSDF_TWO_SIDED);
    EXPECT_TRUE(has_note(scene_, "bump maps of OBJ materials are left out"));
}

TEST(MtlTexturesThatAreGone, NotesSayWhatBecomesOfThem) {
    const SceneFiles files;
    const auto says = [&](const std::string& line, const std::string& what) {
        files.write("m.mtl", "newmtl m\nillum 2\n" + line + " gone.png\n");
        return has_note(load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"),
                        "m.mtl:3: texture is " + what + " because it cannot be read");
    };
    for (const char* line : {"map_d", "map_Ke", "norm", "map_Bump", "map_Pr"}) {
        EXPECT_TRUE(says(line, "left out")) << line;
    }
    EXPECT_TRUE(says("map_Kd", "replaced by mid-grey"));
    EXPECT_TRUE(says("map_Ks", "replaced by mid-grey"));
}

TEST(MtlTexturesWithoutAName, AreNotedAndShowNothing) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl m\nKd 0.2 0.2 0.2\nmap_Kd \nbump\nmap_Ka\nmap_d t.png\n");
    const Scene scene = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    EXPECT_TRUE(has_note(scene, "m.mtl:3: statement 'map_Kd' without the name of a file"));
    EXPECT_TRUE(has_note(scene, "m.mtl:4: statement 'bump' without the name of a file"));
    EXPECT_FALSE(has_note(scene, "'map_Ka' without"));
    EXPECT_FALSE(has_note(scene, "'map_d' without"));
    expect_near(front_of(scene, 0).reflectance.value, {0.2f, 0.2f, 0.2f});
}

}  // namespace
}  // namespace nearlight::core
