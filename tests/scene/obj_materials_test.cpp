// SPDX-License-Identifier: Apache-2.0
// The materials of OBJ scenes.
#include <cmath>

#include "host/image/image_io.h"
#include "host/scene/obj/obj_text.h"
#include "host/scene/texture.h"
#include "tests/scene/obj_text.h"

namespace nearlight::core {
namespace {

using namespace test;

void expect_opacity(const Material& mask, float opacity) {
    EXPECT_EQ(mask.model, NEARLIGHT_BSDF_MASK);
    EXPECT_FLOAT_EQ(mask.reflectance.value.x, opacity);
}

TEST(Obj, MaterialsLightsAndMissingOnes) {
    const SceneFiles files;
    files.write(
        "my lib.mtl",
        "newmtl red wall\nKd 0.8 0.1 0.1\nillum 1\nnewmtl red roof \nKd 0.2 0 0\nnewmtl lamp\nKd 0 0 0\nKe 5 "
        "6 7\n"
        "newmtl paper\nKd 1 1 1\nmap_Kd gone.png\nnewmtl veil\nd 0.1\nnewmtl mirror\nillum 5\nKs 1 1 1\n"
        "newmtl pane\nillum 4\n");
    std::string text = "mtllib my lib.mtl\nmtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char* name : {"red wall", "lamp", "paper", "nobody", "veil", "mirror", "red roof", "pane"}) {
        text += std::string("usemtl ") + name + "\nf 1 2 3\n";
    }
    const Scene scene = load_obj(files, text);
    ASSERT_EQ(scene.triangles.size(), 10u) << "the last is the back of the lamp";
    const auto material = [&](std::size_t i) { return scene.materials[scene.triangles[i].material]; };
    const auto side = [&](std::size_t i) {
        EXPECT_EQ(material(i).model, NEARLIGHT_BSDF_TWO_SIDED);
        EXPECT_EQ(material(i).child[0], material(i).child[1]);
        return scene.materials[material(i).child[0]];
    };
    expect_near(side(0).reflectance.value, {0.5f, 0.5f, 0.5f});
    expect_near(side(1).reflectance.value, {0.8f, 0.1f, 0.1f});
    expect_near(material(2).emission.value, {5, 6, 7});
    expect_near(side(3).reflectance.value, {0.5f, 0.5f, 0.5f});
    EXPECT_EQ(material(5).model, NEARLIGHT_BSDF_MASK);
    EXPECT_FLOAT_EQ(material(5).reflectance.value.x, 0.1f);
    EXPECT_EQ(scene.materials[material(5).child[0]].model, NEARLIGHT_BSDF_TWO_SIDED);
    EXPECT_EQ(side(6).model, NEARLIGHT_BSDF_CONDUCTOR);
    expect_near(side(7).reflectance.value, {0.2f, 0, 0});
    EXPECT_EQ(material(8).model, NEARLIGHT_BSDF_THIN_DIELECTRIC);
    EXPECT_TRUE(has_note(scene, "m.obj:2: material library 'missing.mtl'"));
    EXPECT_TRUE(has_note(scene, "my lib.mtl:11: texture is replaced"));
    EXPECT_TRUE(has_note(scene, "m.obj:13: material 'nobody'"));
    EXPECT_TRUE(scene.delta_emitters.empty());
}

// The material on both sides of the only triangle, with this text as the entry of the library.
Material only_material(const SceneFiles& files, const std::string& entry, Scene* scene = nullptr) {
    files.write("m.mtl", "newmtl m\n" + entry);
    const Scene loaded = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    if (scene != nullptr) {
        *scene = loaded;
    }
    return front_of(loaded, 0);
}

TEST(Obj, HighlightsAreRoughPlastic) {
    const SceneFiles files;
    const Material plastic = only_material(files, "Kd 0.5 0.4 0.3\nKs 0.2 0.3 0.4\nNs 98\nNi 1.6\nillum 2\n");
    EXPECT_EQ(plastic.model, NEARLIGHT_BSDF_PLASTIC);
    expect_near(plastic.reflectance.value, {0.5f, 0.4f, 0.3f});
    expect_near(plastic.specular.value, {0.2f, 0.3f, 0.4f});
    EXPECT_NEAR(plastic.roughness.value.x, std::sqrt(2.0 / 100.0), 1e-6);
    EXPECT_FLOAT_EQ(plastic.eta.x, 1.6f);
    EXPECT_NE(plastic.flags & NEARLIGHT_MATERIAL_BECKMANN, 0u);
    EXPECT_FLOAT_EQ(only_material(files, "Ks 0.5 0.5 0.5\nNs 10\nNi 1\n").eta.x, 1.5f);
    for (const char* matt : {"Kd 1 1 1\nKs 0.5 0.5 0.5\nillum 1\n", "Kd 1 1 1\nKs 0 0 0\nNs 50\nillum 2\n"}) {
        EXPECT_EQ(only_material(files, matt).model, NEARLIGHT_BSDF_DIFFUSE) << matt;
    }
    Scene scene;
    EXPECT_EQ(only_material(files, "Ks 1 1 1\nNs -5\nmap_Ks gone.png\nmap_Ns gone.png\n", &scene).model,
              NEARLIGHT_BSDF_PLASTIC);
    EXPECT_TRUE(has_note(scene, "m.mtl:4: texture is left out"));
    EXPECT_TRUE(has_note(scene, "map_Ns"));
}

TEST(Obj, TexturesAloneGiveHighlightsTheirColour) {
    const SceneFiles files;
    write_image(files.path("t.exr"), {1, 1, {"R", "G", "B"}, {0.2f, 0.3f, 0.4f}});
    Scene scene;
    const auto highlight = [&](const std::string& entry) {
        const Material side = only_material(files, "Kd 0.5 0.5 0.5\nNs 98\n" + entry, &scene);
        return side.model == NEARLIGHT_BSDF_PLASTIC ? parameter_value(scene, side.specular, 0.5f, 0.5f)
                                                    : Vec3{0, 0, 0};
    };
    expect_near(highlight("map_Ks t.exr\nillum 2\n"), {0.2f, 0.3f, 0.4f}, 1e-3f);
    expect_near(highlight("Ks 0.5 0.5 0.5\nmap_Ks t.exr\n"), {0.1f, 0.15f, 0.2f}, 1e-3f);
    expect_near(highlight("Ks 0 0 0\nmap_Ks t.exr\n"), {0, 0, 0});
    expect_near(highlight("map_Ks t.exr\nillum 1\n"), {0, 0, 0});
    expect_near(highlight("map_Ks gone.exr\n"), {0.5f, 0.5f, 0.5f});
    EXPECT_TRUE(has_note(scene, "texture is replaced by mid-grey"));
    only_material(files, "Kd 0.5 0.5 0.5\nmap_Ks t.exr\nillum 3\n", &scene);
    for (const Material& material : scene.materials) {
        EXPECT_NE(material.model, NEARLIGHT_BSDF_CONDUCTOR) << "it would mirror all light";
    }
}

TEST(Obj, EntriesWithoutAColorAreGrey) {
    const SceneFiles files;
    Scene scene;
    expect_near(only_material(files, "Ka 1 1 1\nNs 10\nillum 2\n", &scene).reflectance.value,
                {0.5f, 0.5f, 0.5f});
    EXPECT_TRUE(has_note(scene, "m.mtl:1: a material without any colour"));
    for (const char* black : {"Kd 0 0 0\n", "Ke 5 5 5\n"}) {
        expect_near(only_material(files, black, &scene).reflectance.value, {0, 0, 0});
        EXPECT_FALSE(has_note(scene, "without any colour")) << black;
    }
}

TEST(Obj, EntriesWithoutAColorLeaveThoseOfVertices) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl m\nNs 10\n");
    const Scene scene =
        load_obj(files, "mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nusemtl m\nf 1 2 3\n");
    const Material& surface = front_of(scene, 0);
    expect_near(surface.reflectance.value, {1, 1, 1});
    EXPECT_GE(surface.reflectance.texture, 0);
    EXPECT_FALSE(has_note(scene, "without any colour"));
}

TEST(Obj, HaloIsNoOpacity) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl m\nKd 1 1 1\nd -halo 0.25\n");
    const Scene scene = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    EXPECT_FLOAT_EQ(scene.materials[scene.triangles.at(0).material].reflectance.value.x, 0.25f);
    EXPECT_TRUE(has_note(scene, "m.mtl:1: the opacity (d -halo)"));
}

TEST(Obj, RoughnessAndMetalnessArePrincipled) {
    const SceneFiles files;
    const Material metal =
        only_material(files, "Kd 0.9 0.6 0.2\nKs 0.5 0.5 0.5\nNs 30\nPr 0.3\nPm 1\nillum 3\n");
    EXPECT_EQ(metal.model, NEARLIGHT_BSDF_PRINCIPLED);
    expect_near(metal.reflectance.value, {0.9f, 0.6f, 0.2f});
    EXPECT_FLOAT_EQ(metal.roughness.value.x, 0.3f);
    EXPECT_FLOAT_EQ(metal.metallic.value.x, 1.0f);
    EXPECT_FLOAT_EQ(only_material(files, "Kd 1 1 1\nPr 7\n").roughness.value.x, 1.0f);
    Scene scene;
    only_material(files, "Kd 1 1 1\nPm 0.5\nPs 0.3\nPc 0.2\n", &scene);
    EXPECT_TRUE(has_note(scene, "m.mtl:1: sheen, clear coat"));
}

TEST(Obj, LinesOfWhatIsLeftOut) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\n\nmap_Kd no.png\nnewmtl c\nmap_Kd no2.png\n");
    const Scene scene =
        load_obj(files,
                 "mtllib m.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\n"
                 "f 1/1 2/1 3/1\nusemtl b\nf 1/1 2/1 3/1\nusemtl d\nf 1/1 2/1 3/1\n");
    const auto line_of = [&](const std::string& text) {
        const auto note =
            std::ranges::find_if(scene.notes, [&](const Note& n) { return mentions(n.text, text); });
        return note == scene.notes.end() ? -1 : note->line;
    };
    EXPECT_EQ(line_of("gone.mtl"), 2);
    EXPECT_EQ(line_of("'d' is not defined"), 11);
    EXPECT_EQ(line_of("no.png"), 5);
}

TEST(Obj, LinesOfABlockThatIsNotThere) {
    const std::string text = "newmtl a\nillum 2\nnewmtl b\nillum 4\n";
    const auto line = [&](const TextLine& first, const std::string& value) {
        return find_in_block(text, first, "newmtl", "illum", value);
    };
    const auto blocks = lines_by_value(text, "newmtl");
    EXPECT_EQ(line(blocks.at("b"), "4"), 4);
    EXPECT_EQ(line(blocks.at("a"), "4"), 0) << "it is in the next block";
    EXPECT_EQ(line({}, "2"), 0);
}

TEST(Obj, SeveralLibrariesOnOneLine) {
    const SceneFiles files;
    files.write("a.mtl", "newmtl a\nKd 0.1 0.1 0.1\nillum 1\n");
    files.write("b.mtl", "newmtl b\nKd 0.2 0.2 0.2\nillum 1\n");
    const Scene scene = load_obj(files,
                                 "mtllib a.mtl b.mtl none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"
                                 "usemtl b\nf 1 2 3\n");
    const auto reflectance = [&](std::size_t i) { return front_of(scene, i).reflectance.value.x; };
    EXPECT_FLOAT_EQ(reflectance(0), 0.1f);
    EXPECT_FLOAT_EQ(reflectance(1), 0.2f);
    EXPECT_TRUE(has_note(scene, "m.obj:1: material library 'none.mtl' cannot be read"));
}

TEST(Obj, KeywordsOfLibrariesMayHaveAnyCase) {
    const SceneFiles files;
    files.write("m.mtl", "NEWMTL Wall\nkd 0.8 0.1 0.2\nILLUM\t1\nD 0.5\n");
    const Scene scene = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Wall\nf 1 2 3\n");
    const Material& mask = scene.materials[scene.triangles.at(0).material];
    expect_opacity(mask, 0.5f);
    expect_near(scene.materials.at(scene.materials.at(mask.child[0]).child[0]).reflectance.value,
                {0.8f, 0.1f, 0.2f});
}

TEST(Obj, StatementsThatAreLeftOutAreNotedOnce) {
    const SceneFiles files;
    files.write(
        "m.mtl",
        "newmtl a\nKa 1 1 1\nmap_Ka x.png\nMAP_AAT on\nsharpness 60\nKd 1 1 1\nrefl -type sphere s.png\n"
        "newmtl b\n refl t.png\ndecal d.png\nshine 3\r\n# gloss 4\nend\n0 1\nnewmtl c\nsheen 1\n");
    const Scene scene =
        load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
    std::vector<std::string> statements;
    for (const Note& note : scene.notes) {
        if (mentions(note.text, "statement ")) {
            statements.push_back(std::to_string(note.line) + " " + note.text);
        }
    }
    const std::string rest = " of OBJ materials is left out";
    EXPECT_EQ(statements, (std::vector{"7 statement 'refl'" + rest, "10 statement 'decal'" + rest,
                                       "11 statement 'shine'" + rest}));
    EXPECT_TRUE(mentions(file_error([&] { load_scene(files.path("m.obj"), {.strict = true}); }),
                         "m.mtl:7: statement 'refl'"));
}

TEST(Obj, StatementsWithoutTheirNumberAreNoted) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl m\nKd red\nNs 10\nd -halo 1\nmap_Kd t.png\nillum\n");
    const Scene scene = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    EXPECT_TRUE(has_note(scene, "m.mtl:2: statement 'Kd' without a number"));
    EXPECT_FALSE(has_note(scene, "'Ns' without"));
    EXPECT_FALSE(has_note(scene, "'d' without"));
}

TEST(Obj, MirrorsReflectKsAndScatterKd) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl m\nKd 0.2 0.1 0\nKs 0.4 0.5 0.5\nillum 3\n");
    const Scene scene = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    const Material blend = scene.materials[scene.triangles.at(0).material];
    ASSERT_EQ(blend.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(blend.reflectance.value.x, 0.5f);
    const auto side = [&](int child) {
        return scene.materials[scene.materials[blend.child[child]].child[0]];
    };
    EXPECT_EQ(side(0).model, NEARLIGHT_BSDF_DIFFUSE);
    expect_near(side(0).reflectance.value, {0.4f, 0.2f, 0});
    EXPECT_EQ(side(1).model, NEARLIGHT_BSDF_CONDUCTOR);
    expect_near(side(1).specular.value, {0.8f, 1, 1});
    expect_near(only_material(files, "Kd 0.3 0.3 0.3\nillum 3\n").reflectance.value, {0.3f, 0.3f, 0.3f});
}

/// Blender's exporter writes metalness as Ka, and roughness as Ns = 1000·(1 − roughness)².
TEST(Obj, BlendersMetalAndPlastic) {
    const SceneFiles files;
    const auto material = [&](const std::string& entry) {
        files.write("b.mtl", "# Blender 4.0.2 MTL File: 'a.blend'\n\nnewmtl m\n" + entry);
        const Scene scene = load_obj(files, "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
        return front_of(scene, 0);
    };
    const Material metal = material("Ns 250\nKa 0.9 0.9 0.9\nKd 1 0.77 0.34\nKs 0.5 0.5 0.5\nillum 3\n");
    EXPECT_EQ(metal.model, NEARLIGHT_BSDF_PRINCIPLED);
    expect_near(metal.reflectance.value, {1, 0.77f, 0.34f});
    EXPECT_NEAR(metal.roughness.value.x, 0.5f, 1e-6f);
    EXPECT_FLOAT_EQ(metal.metallic.value.x, 0.9f);
    const Material plastic = material("Ns 1000\nKa 1 1 1\nKd 1 1 1\nKs 0.5 0.5 0.5\nNi 1.45\nillum 2\n");
    EXPECT_EQ(plastic.model, NEARLIGHT_BSDF_PRINCIPLED);
    EXPECT_EQ(plastic.flags & NEARLIGHT_MATERIAL_LAYERED, NEARLIGHT_MATERIAL_LAYERED);
    EXPECT_FLOAT_EQ(plastic.roughness.value.x, 0.0f);
    EXPECT_FLOAT_EQ(plastic.metallic.value.x, 0.0f);
    EXPECT_FLOAT_EQ(plastic.eta.x, 1.45f);
    EXPECT_EQ(material("Ns 0\nKd 1 1 1\nKs 0 0 0\nillum 1\n").model, NEARLIGHT_BSDF_DIFFUSE);
}

/// Blender writes illum 9 for every surface with an opacity below 1.
TEST(Obj, BlendersTransparencyIsNoGlass) {
    const SceneFiles files;
    files.write("b.mtl", "# Blender 4.0.2 MTL File: 'a.blend'\nnewmtl m\nKs 0.5 0.5 0.5\nd 0.25\nillum 9\n");
    const Scene scene = load_obj(files, "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    expect_opacity(scene.materials[scene.triangles.at(0).material], 0.25f);
}

/// Before Blender 3, only the OBJ file told the version, and 900 was the exponent of smooth surfaces.
TEST(Obj, OlderBlendersRoughness) {
    const SceneFiles files;
    files.write("b.mtl",
                "# Blender MTL File: 'a.blend'\n# Material Count: 1\n\nnewmtl m\nNs 225\nKa 1 1 1\n"
                "Kd 1 1 1\nKs 0.5 0.5 0.5\nNi 1.45\nillum 2\n");
    const auto material = [&](const std::string& version) {
        const Scene scene = load_obj(files, "# Blender v" + version +
                                                " OBJ File: 'a.blend'\nmtllib b.mtl\nv 0 0 0\nv 1 0 0\n"
                                                "v 0 1 0\nusemtl m\nf 1 2 3\n");
        return front_of(scene, 0);
    };
    for (const char* version : {"2.80 (sub 75)", "2.93.1"}) {
        EXPECT_EQ(material(version).model, NEARLIGHT_BSDF_PRINCIPLED) << version;
        EXPECT_NEAR(material(version).roughness.value.x, 0.5f, 1e-6f) << version;
    }
    EXPECT_EQ(material("2.79 (sub 0)").model, NEARLIGHT_BSDF_PLASTIC);
}

TEST(Obj, TfTintsGlass) {
    const SceneFiles files;
    const auto pane = [&](const std::string& entry) {
        files.write("m.mtl", "newmtl m\nillum 4\n" + entry);
        const Scene scene = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
        return scene.materials[scene.triangles.at(0).material];
    };
    expect_near(pane("Tf 0.9 0.5 0.1\n").transmission.value, {1, 5.0f / 9, 1.0f / 9});
    expect_near(pane("Tf 0.1 0.1 0.1\n").transmission.value, {1, 1, 1});
    expect_near(pane("").transmission.value, {1, 1, 1});
}

/// Maya writes illum 4 for all surfaces.
TEST(Obj, Illum4IsGlassOnlyIfSomethingSaysSo) {
    const SceneFiles files;
    const auto model = [&](const std::string& entry) {
        files.write("m.mtl", "newmtl m\nillum 4\n" + entry);
        const Scene scene = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
        const Material material = scene.materials[scene.triangles.at(0).material];
        return material.model == NEARLIGHT_BSDF_TWO_SIDED ? scene.materials[material.child[0]].model
                                                          : material.model;
    };
    EXPECT_EQ(model("Kd 0.5 0.5 0.5\nTf 1 1 1\nNi 1\nKs 0.5 0.5 0.5\nNs 18\n"), NEARLIGHT_BSDF_PLASTIC);
    for (const char* glass : {"Kd 0 0 0\n", "Kd 0.5 0.5 0.5\nd 0.2\n", "Kd 0.5 0.5 0.5\nNi 1.5\n"}) {
        EXPECT_EQ(model(glass), NEARLIGHT_BSDF_THIN_DIELECTRIC) << glass;
    }
}

/// A surface that refracts is a body if it has no border.
TEST(Obj, ClosedGlassIsABody) {
    const SceneFiles files;
    const std::string tetrahedron =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl m\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";
    const auto glass = [&](const char* model, const std::string& faces) {
        files.write("m.mtl", std::string("newmtl m\nTf 0.25 1 1\nNi 1.33\nillum ") + model + "\n");
        const Scene scene =
            load_obj(files, "mtllib m.mtl\n" + tetrahedron + faces + "usemtl other\nf 1 2 3\n");
        return scene.materials[scene.triangles.at(0).material];
    };
    const Material body = glass("7", "f 1 4 3\n");
    EXPECT_EQ(body.model, NEARLIGHT_BSDF_DIELECTRIC);
    EXPECT_FLOAT_EQ(body.eta.x, 1.33f);
    EXPECT_FLOAT_EQ(body.transmission.value.x, 0.5f);
    EXPECT_EQ(glass("7", "").model, NEARLIGHT_BSDF_THIN_DIELECTRIC);
    EXPECT_EQ(glass("9", "f 1 4 3\n").model, NEARLIGHT_BSDF_DIELECTRIC);
    EXPECT_EQ(glass("9", "").model, NEARLIGHT_BSDF_THIN_DIELECTRIC);
    EXPECT_EQ(glass("4", "f 1 4 3\n").model, NEARLIGHT_BSDF_THIN_DIELECTRIC);
}

/// Mitsuba 0.5 and 0.6 give each material of the file the BSDF of its name, or what its library says.
TEST(Obj, ShapesOfOldMitsubaHaveSeveralMaterials) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl Red_1\nKd 0.8 0.1 0.1\nnewmtl green\nKd 0.1 0.8 0.1\n");
    files.write("m.obj",
                "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Red_1\nf 1 2 3\n"
                "usemtl green\nf 3 2 1\n");
    const auto colors = [&](const std::string& version, const std::string& bsdfs) {
        const Scene scene = load_scene(files.write(
            "scene.xml", "<scene version='" + version + "'><bsdf type='diffuse' id='own'>" +
                             "<rgb name='reflectance' value='0.3'/></bsdf><shape type='obj'>" +
                             "<string name='filename' value='m.obj'/>" + bsdfs + "</shape></scene>"));
        EXPECT_FALSE(has_note(scene, "ignored"));
        std::vector<float> greens;
        for (const Triangle& triangle : scene.triangles) {
            const Material& outer = scene.materials[triangle.material];
            const bool has_sides = outer.model == NEARLIGHT_BSDF_TWO_SIDED;
            greens.push_back((has_sides ? scene.materials[outer.child[0]] : outer).reflectance.value.y);
        }
        return greens;
    };
    using Greens = std::vector<float>;
    EXPECT_EQ(colors("0.6.0", ""), (Greens{0.1f, 0.8f}));
    EXPECT_EQ(colors("0.6.0", "<ref name='Red_1' id='own'/>"), (Greens{0.3f, 0.8f}));
    EXPECT_EQ(colors("0.5.0", "<ref name='Red_1' id='own'/><ref name='green' id='own'/>"),
              (Greens{0.3f, 0.3f}));
    EXPECT_EQ(colors("0.6.0", "<ref id='own'/>"), (Greens{0.3f, 0.3f}));
    EXPECT_EQ(colors("0.6.0", "<boolean name='loadMaterials' value='false'/>"), (Greens{0.5f, 0.5f}));
    EXPECT_EQ(colors("3.0.0", ""), (Greens{0.5f, 0.5f})) << "libraries are not read there";
}

TEST(Obj, OtherShapesHaveOneBsdfAndOneEmitter) {
    const SceneFiles files;
    const std::string twice = "<bsdf type='diffuse'/><bsdf type='diffuse'/>";
    EXPECT_TRUE(mentions(file_error([&] { files.load_xml("<shape type='cube'>" + twice + "</shape>"); }),
                         "scene.xml:2: a shape has one BSDF, but this one has 2"));
    const std::string lamps = "<emitter type='area'/><emitter type='area'/>";
    EXPECT_TRUE(mentions(file_error([&] { files.load_xml("<shape type='cube'>" + lamps + "</shape>"); }),
                         "scene.xml:2: a shape has only one emitter"));
    const Scene old =
        load_scene(files.write("scene.xml",
                               "<scene version='0.6.0'><shape type='cube'><bsdf type='conductor'/>"
                               "<bsdf type='dielectric'/></shape></scene>"));
    EXPECT_EQ(old.materials[old.triangles.at(0).material].model, NEARLIGHT_BSDF_DIELECTRIC);
    EXPECT_TRUE(has_note(old, "the last one counts"));
}

}  // namespace
}  // namespace nearlight::core
