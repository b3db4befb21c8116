// SPDX-License-Identifier: Apache-2.0
// What moves, multiplies, compresses and colours the vertices of glTF meshes.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "host/image/image_io.h"
#include "host/scene/gltf/draco_codec.h"
#include "host/scene/texture.h"
#include "tests/scene/gltf_text.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using namespace test;

TEST_F(GltfLoader, SkinsStandAsTheirJointsDo) {
    // The first joint is where the mesh was bound; the second one has moved by (0, 0, 5) since.
    const std::vector<float> bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                  1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1};
    gltf_.root["skins"] = {
        {{"joints", {1, 2}}, {"inverseBindMatrices", gltf_.accessor(bind, 5126, "MAT4", 16)}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                           {{"children", {2}}},
                           {{"translation", {2, 0, 5}}}};
    gltf_.root["scenes"][0]["nodes"] = {0, 1};
    json& attributes = gltf_.primitive()["attributes"];
    attributes["JOINTS_0"] = gltf_.accessor(
        std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, 5121, "VEC4", 4);
    attributes["WEIGHTS_0"] = gltf_.accessor(
        std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
    const Scene scene = load();
    expect_close(corner(scene, 0, 0), {0, 0, 0});  // the place of the mesh's own node does not count
    expect_close(corner(scene, 0, 1), {1, 0, 5});
    expect_close(corner(scene, 0, 2), {1, 1, 2.5f});
    gltf_.root["skins"][0]["joints"] = {1};
    EXPECT_THAT(error(), HasSubstr("joint 1"));
    gltf_.root["skins"][0]["joints"] = {1, 77};
    EXPECT_THAT(error(), HasSubstr("node 77"));
}

/// A joint that stretches a mesh turns its normals as a node that does.
TEST_F(GltfLoader, NormalsOfStretchedSkinsStayNormal) {
    const float half = std::sqrt(0.5f);
    json& attributes = gltf_.primitive()["attributes"];
    attributes["NORMAL"] = gltf_.points({half, 0, half, half, 0, half, half, 0, half, half, 0, half});
    gltf_.root["nodes"] = {{{"mesh", 0}, {"scale", {1, 1, 4}}}};
    const Scene by_node = load();
    attributes["JOINTS_0"] = gltf_.accessor(std::vector<std::uint8_t>(16, 0), 5121, "VEC4", 4);
    attributes["WEIGHTS_0"] =
        gltf_.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
    gltf_.root["skins"] = {{{"joints", {1}}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"scale", {1, 1, 4}}}};
    gltf_.root["scenes"][0]["nodes"] = {0, 1};
    const Scene by_joint = load();
    ASSERT_EQ(by_joint.vertices.size(), by_node.vertices.size());
    for (std::size_t i = 0; i < by_node.vertices.size(); ++i) {
        expect_close(by_node.vertices[i].normal, {4 / std::sqrt(17.0f), 0, 1 / std::sqrt(17.0f)});
        expect_close(by_joint.vertices[i].normal, by_node.vertices[i].normal);
    }
}

TEST_F(GltfLoader, MorphTargetsHaveTheWeightsOfTheNodeOrTheMesh) {
    gltf_.primitive()["targets"] = {{{"POSITION", gltf_.points({0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4})}},
                                    {{"POSITION", gltf_.points({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0})}}};
    expect_close(corner(load(), 0, 2), {1, 1, 0});
    gltf_.root["meshes"][0]["weights"] = {0.5, 0};
    expect_close(corner(load(), 0, 2), {1, 1, 1.5f});
    gltf_.root["nodes"][0]["weights"] = {1, -1};
    expect_close(corner(load(), 0, 2), {0, 1, 3});
}

TEST_F(GltfLoader, MorphTargetsOfColoursAreNoted) {
    gltf_.primitive()["targets"] = {{{"COLOR_0", gltf_.points({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})}}};
    EXPECT_FALSE(has_note(load(), "morph targets"));
    gltf_.root["meshes"][0]["weights"] = {1};
    EXPECT_TRUE(has_note(load(), "morph targets of COLOR_0 are left out"));
}

TEST_F(GltfLoader, InstancesStandBelowTheirNode) {
    const double half = std::sqrt(0.5);
    const auto h = static_cast<float>(half);
    gltf_.root["nodes"][0]["translation"] = {0, 0, 9};
    gltf_.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", gltf_.points({0, 0, 0, 5, 0, 0})},
        {"ROTATION", gltf_.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, h, h}, 5126, "VEC4", 4)},
        {"SCALE", gltf_.points({1, 1, 1, 2, 2, 2})}};
    gltf_.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), 4u);
    expect_close(corner(scene, 0, 1), {1, 0, 9});
    expect_close(corner(scene, 2, 1), {5, 2, 9});
    gltf_.root["accessors"].push_back({{"componentType", 5126}, {"count", 2000000}, {"type", "VEC3"}});
    gltf_.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", gltf_.root["accessors"].size() - 1}};
    EXPECT_THAT(error(), HasSubstr("has 2000000 instances; the maximum is 1048576"));
}

TEST_F(GltfLoader, QuantizedPositions) {
    gltf_.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    gltf_.primitive()["attributes"]["POSITION"] = gltf_.accessor(
        std::vector<std::int16_t>{0, 0, 0, 300, 0, 0, 300, 300, 0, 0, 300, 0}, 5122, "VEC3", 3);
    gltf_.root["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
    expect_close(corner(load(), 0, 2), {3, 3, 0});
}

TEST_F(GltfLoader, WithoutNormalsFacetsAreFlat) {
    gltf_.primitive()["attributes"]["POSITION"] = gltf_.points({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1});
    EXPECT_TRUE(is_zero(load().vertices[0].normal));
    gltf_.root["nodes"][0]["scale"] = {-1, 1, 1};
    const Scene mirrored = load();  // and the front stays the front
    const Vec3 normal = cross(corner(mirrored, 0, 1) - corner(mirrored, 0, 0),
                              corner(mirrored, 0, 2) - corner(mirrored, 0, 0));
    EXPECT_GT(normal.z, 0.0f);
}

/// The side to which a triangle shines is that from which its corners run counter-clockwise.
float front_z(const Scene& scene, std::size_t triangle) {
    return cross(corner(scene, triangle, 1) - corner(scene, triangle, 0),
                 corner(scene, triangle, 2) - corner(scene, triangle, 0))
        .z;
}

TEST_F(GltfLoader, TheOrderOfCornersSaysWhereTheFrontIs) {
    json& attributes = gltf_.primitive()["attributes"];
    attributes["NORMAL"] = gltf_.points({0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1});
    for (const double x : {1, -1}) {
        gltf_.root["nodes"][0]["scale"] = {x, 1, 1};
        const Scene scene = load();
        ASSERT_EQ(scene.vertices.size(), 4u);
        for (const std::size_t triangle : {0, 1}) {
            EXPECT_GT(front_z(scene, triangle), 0.0f);
        }
        for (const Vertex& vertex : scene.vertices) {
            expect_close(vertex.normal, {0, 0, 1});
        }
    }
    attributes["JOINTS_0"] = gltf_.accessor(std::vector<std::uint8_t>(16, 0), 5121, "VEC4", 4);
    attributes["WEIGHTS_0"] =
        gltf_.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
    gltf_.root["skins"] = {{{"joints", {1}}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"scale", {-1, 1, 1}}}};
    gltf_.root["scenes"][0]["nodes"] = {0, 1};
    EXPECT_GT(front_z(load(), 0), 0.0f) << "joints that mirror keep the front in front";
}

TEST_F(GltfLoader, OnlyNormalsOnTheOtherSideAreTurned) {
    gltf_.primitive()["attributes"]["NORMAL"] = gltf_.points({0, 0, 2, 0, 0, 1, 0, 0, -1, 0, 0, -3});
    const Scene scene = load();
    EXPECT_EQ(scene.vertices.size(), 6u) << "both triangles have two vertices in common";
    const auto expect_triangle = [&](std::size_t triangle, const std::array<float, 3>& normals) {
        EXPECT_GT(front_z(scene, triangle), 0.0f);
        const Triangle& t = scene.triangles.at(triangle);
        EXPECT_EQ(scene.vertices.at(t.v0).normal.z, normals[0]);
        EXPECT_EQ(scene.vertices.at(t.v1).normal.z, normals[1]);
        EXPECT_EQ(scene.vertices.at(t.v2).normal.z, normals[2]);
    };
    expect_triangle(0, {1, 1, -1});
    expect_triangle(1, {-1, 1, 1});
    expect_close(corner(scene, 1, 1), {1, 1, 0});
    EXPECT_EQ(scene.vertices.at(scene.triangles.at(1).v1).u, 1.0f);
}

TEST_F(GltfLoader, VertexColoursMultiplyTheBase) {
    gltf_.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 1, 1, 1}}, {"metallicFactor", 0}};
    gltf_.primitive()["attributes"]["COLOR_0"] = gltf_.accessor(
        std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 51}, 5121,
        "VEC4", 4, true);
    const Scene scene = load();
    expect_close(scene.vertex_colors.at(1), {0, 1, 0});
    const Material& side = scene.materials.at(scene.materials.at(scene.triangles[0].material).child[0]);
    ASSERT_GE(side.reflectance.texture, 0);
    EXPECT_EQ(scene.textures.at(0).parameters.kind, NEARLIGHT_TEXTURE_VERTEX_COLOR);
    expect_close(side.reflectance.value, {0.5f, 1, 1});
    EXPECT_FALSE(has_note(scene, "alpha of vertex colours"));  // an opaque material has no use for it
    EXPECT_TRUE(scene.second_uvs.empty());
}

TEST_F(GltfLoader, VertexAlphasMakeHoles) {
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}},
                        {"alphaMode", "BLEND"},
                        {"emissiveFactor", {2, 2, 2}}};
    gltf_.primitive()["attributes"]["COLOR_0"] = gltf_.accessor(
        std::vector<float>{1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 0.3f, 1, 1, 1, 0.6f}, 5126, "VEC4", 4);
    /// The opacity of all masks where the alpha of vertices is this, and the radiance.
    const auto look = [&](float alpha) {
        const Scene scene = load();
        EXPECT_EQ(scene.second_uvs.at(3)[0], 0.6f);
        const Material* material = &scene.materials.at(scene.triangles[0].material);
        std::array<float, 2> found{1, parameter_value(scene, material->emission, 0, 0, kWhite, {alpha, 0}).x};
        for (; material->model == NEARLIGHT_BSDF_MASK; material = &scene.materials.at(material->child[0])) {
            found[0] *= parameter_value(scene, material->reflectance, 0, 0, kWhite, {alpha, 0}).x;
        }
        return found;
    };
    for (const float alpha : {0.0f, 0.1f, 0.3f, 0.75f, 1.0f}) {
        EXPECT_NEAR(look(alpha)[0], 0.5f * alpha, 1e-6f);
        EXPECT_NEAR(look(alpha)[1], 2 * 0.5f * alpha, 1e-6f);
    }
    gltf_.material()["alphaMode"] = "MASK";
    gltf_.material()["alphaCutoff"] = 0.2;  // half of the alphas
    for (const auto& [alpha, kept] : {std::pair{0.39f, 0.0f}, {0.41f, 1.0f}, {1.0f, 1.0f}}) {
        EXPECT_EQ(look(alpha)[0], kept);
        EXPECT_EQ(look(alpha)[1], 2 * kept);
    }
}

TEST_F(GltfLoader, VertexAlphasBesideTexturesCountOrAreNoted) {
    write_image(files_.path("texel.exr"), {1, 1, {"R", "G", "B", "A"}, {1, 1, 1, 0.5f}});
    gltf_.root["images"] = {{{"uri", "texel.exr"}}};
    gltf_.root["textures"] = {{{"source", 0}}};
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"alphaMode", "BLEND"}};
    json& attributes = gltf_.primitive()["attributes"];
    attributes["COLOR_0"] = gltf_.accessor(std::vector<float>(16, 0.5f), 5126, "VEC4", 4);
    const Scene blend = load();
    EXPECT_FALSE(has_note(blend, "alpha of vertex colours"));
    const Material& outer = blend.materials.at(blend.triangles[0].material);
    const Material& inner = blend.materials.at(outer.child[0]);
    EXPECT_EQ(outer.model, NEARLIGHT_BSDF_MASK);
    EXPECT_EQ(inner.model, NEARLIGHT_BSDF_MASK);
    EXPECT_NEAR(parameter_value(blend, inner.reflectance, 0, 0, kWhite, {0.25f, 0}).x, 0.5f, 1e-3f);
    EXPECT_NEAR(parameter_value(blend, outer.reflectance, 0, 0, kWhite, {0.25f, 0}).x, 0.25f, 1e-6f);
    gltf_.material()["alphaMode"] = "MASK";
    EXPECT_TRUE(has_note(load(), "alpha of vertex colours is left out where a texture makes a mask"));
    gltf_.material()["alphaMode"] = "BLEND";
    gltf_.material()["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
    attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"];
    EXPECT_TRUE(has_note(load(), "alpha of vertex colours is left out beside two sets"));
}

TEST_F(GltfLoader, TwoSetsOfTextureCoordinates) {
    write_image(files_.path("texel.exr"), {1, 1, {"R", "G", "B"}, {1, 1, 1}});
    gltf_.root["images"] = {{{"uri", "texel.exr"}}};
    gltf_.root["textures"] = {{{"source", 0}}};
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}},
                        {"emissiveTexture", {{"index", 0}, {"texCoord", 0}}},
                        {"emissiveFactor", {1, 1, 1}}};
    gltf_.primitive()["attributes"]["TEXCOORD_1"] =
        gltf_.accessor(std::vector<float>{0.25f, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2", 2);
    const Scene scene = load();
    EXPECT_EQ(scene.vertices.at(0).u, 0.25f);  // the base's set is the first
    ASSERT_EQ(scene.second_uvs.size(), scene.vertices.size());
    EXPECT_EQ(scene.second_uvs[0][0], 0.0f);
    const Material& top = scene.materials.at(scene.triangles[0].material);
    const auto emission = static_cast<std::size_t>(top.emission.texture);
    EXPECT_EQ(scene.textures.at(emission).parameters.flags, NEARLIGHT_TEXTURE_SECOND_UV);
    // Any two sets of a mesh will do.
    json& attributes = gltf_.primitive()["attributes"];
    attributes["TEXCOORD_5"] = attributes["TEXCOORD_1"];
    gltf_.material()["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 5;
    EXPECT_EQ(load().vertices.at(0).u, 0.25f);
    gltf_.material()["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
    EXPECT_THAT(error(), HasSubstr("more than two sets of texture coordinates"));
    gltf_.material()["emissiveFactor"] = {0, 0, 0};
    EXPECT_EQ(load().triangles.size(), 2u) << "nobody sees the emissive texture";
    for (const std::string name : {"transmission", "clearcoat"}) {
        json& extension = gltf_.material()["extensions"]["KHR_materials_" + name];
        extension = {{name + "Factor", 0}, {name + "Texture", {{"index", 0}, {"texCoord", 7}}}};
        EXPECT_EQ(load().triangles.size(), 2u) << name;
        extension[name + "Factor"] = 0.5;
        EXPECT_THAT(error(), HasSubstr("more than two sets of texture coordinates")) << name;
        extension[name + "Factor"] = 0;
    }
}

TEST_F(GltfLoader, CoordinatesThatNoMeshHasAreZeroForEveryVertex) {
    write_image(files_.path("texel.exr"), {1, 1, {"R", "G", "B"}, {1, 1, 1}});
    gltf_.root["images"] = {{{"uri", "texel.exr"}}};
    gltf_.root["textures"] = {{{"source", 0}}};
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}},
                        {"emissiveFactor", {1, 1, 1}}};
    const Scene scene = load();
    EXPECT_EQ(scene.second_uvs, (std::vector<std::array<float, 2>>(scene.vertices.size(), {0, 0})));
    EXPECT_TRUE(has_note(scene, "asks for TEXCOORD_1"));
    gltf_.material()["emissiveTexture"]["texCoord"] = -1;
    EXPECT_THAT(error(), HasSubstr("asks for the set -1"));
    gltf_.material()["emissiveTexture"] = {{"index", 0},
                                           {"extensions", {{"KHR_texture_transform", {{"texCoord", -3}}}}}};
    EXPECT_THAT(error(), HasSubstr("asks for the set -1"));
}

TEST_F(GltfLoader, MeshesThatNoSurfaceCanHaveAreRefusedBeforeTheyAreLookedAt) {
    gltf_.material() = {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}};
    json& primitive = gltf_.primitive();
    const json before = primitive;
    primitive["indices"] =
        gltf_.accessor(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 4'000'000}, 5125, "SCALAR", 1);
    EXPECT_THAT(error(), HasSubstr("uses vertex 4000000, but there are only 4"));
    primitive = before;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    primitive["attributes"]["POSITION"] = gltf_.points({0, 0, 0, 1, 0, 0, 1, nan, 0, 0, 1, 0});
    EXPECT_THAT(error(), HasSubstr("node 'thing' has a position that is not finite"));
    primitive = before;
    primitive["attributes"]["TEXCOORD_0"] = gltf_.accessor(std::vector<float>{0, 1}, 5126, "VEC2", 2);
    EXPECT_THAT(error(), HasSubstr("differ from the number of vertices"));
}

TEST_F(GltfLoader, SurfacesThatShineToBothSidesHaveABack) {
    gltf_.material()["emissiveFactor"] = {1, 1, 1};
    EXPECT_EQ(load().triangles.size(), 2u);
    gltf_.material()["doubleSided"] = true;
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), 4u);
    const Vec3 back =
        cross(corner(scene, 2, 1) - corner(scene, 2, 0), corner(scene, 2, 2) - corner(scene, 2, 0));
    EXPECT_LT(back.z, 0.0f);
    EXPECT_LT(corner(scene, 2, 0).z, 0.0f);
    EXPECT_GT(corner(scene, 2, 0).z, -1e-3f);
    EXPECT_EQ(scene.triangles[2].material, scene.triangles[0].material);
}

TEST_F(GltfLoader, TheBackOfATransparentSurfaceOnlyShines) {
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}},
                        {"alphaMode", "BLEND"},
                        {"emissiveFactor", {1, 1, 1}},
                        {"doubleSided", true}};
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), 4u);
    const Material& front = scene.materials.at(scene.triangles[0].material);
    const Material& back = scene.materials.at(scene.triangles[2].material);
    EXPECT_EQ(front.model, NEARLIGHT_BSDF_MASK);
    EXPECT_EQ(front.reflectance.value.x, 0.25f);
    EXPECT_EQ(back.model, NEARLIGHT_BSDF_NULL);
    EXPECT_EQ(back.emission.value, front.emission.value);
    EXPECT_EQ(scene.triangles[3].material, scene.triangles[2].material);
}

TEST_F(GltfLoader, HiddenNodesAreLeftOut) {
    gltf_.root["nodes"] = {{{"mesh", 0}, {"children", {1}}},
                           {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}}};
    EXPECT_EQ(load().triangles.size(), 2u);
}

/// Files whose meshes Draco, which a build may lack, has compressed.
class GltfDraco : public GltfLoader {
  protected:
    void SetUp() override {
        if (!gltf::can_decode_draco()) {
            GTEST_SKIP() << "the build found no Draco (libdraco-dev), so that files that need it are refused";
        }
        gltf_.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
        gltf_.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    }
};

/// A triangle of 4 by 2 as Draco 1.5.5 packs it, with the ids 0 for positions and 1 for colours.
constexpr const char* kCompressedTriangle =
    "RFJBQ08CAgEBAAAAAwEBAQAAAQf/AREBAQAC/"
    "wAAAAAAAQAJAwAAAAECAgMBAQEAAIBAAAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAA"
    "AAABAQEAAwOtKlUVA6B6gSoKAAAAAP8AAAA=";

TEST_F(GltfDraco, CompressedMeshes) {
    const int view = gltf_.view(from_base64(kCompressedTriangle));
    gltf_.root["accessors"] = {{{"componentType", 5125}, {"count", 3}, {"type", "SCALAR"}},
                               {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}};
    gltf_.primitive() = {{"indices", 0}, {"attributes", {{"POSITION", 1}}}};
    json& packed = gltf_.primitive()["extensions"]["KHR_draco_mesh_compression"];
    packed = {{"bufferView", view}, {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
    for (const bool binary : {false, true}) {
        const Scene scene = load_scene(binary ? files_.write("scene.glb", gltf_.binary())
                                              : files_.write("scene.gltf", gltf_.text()));
        ASSERT_EQ(scene.triangles.size(), 1u);
        EXPECT_NEAR(triangle_area(scene, scene.triangles[0]), 4.0f, 1e-2f);
        Vec3 sum{0, 0, 0};
        for (const Vec3 color : scene.vertex_colors) {
            sum += color;
        }
        expect_close(sum, {2, 2, 1});  // red, green and white
    }
    packed["attributes"]["POSITION"] = 7;
    EXPECT_THAT(error(), HasSubstr("lacks its attribute POSITION"));
    packed["attributes"]["POSITION"] = 0;
    packed["bufferView"] = 0;
    EXPECT_THAT(error(), HasSubstr("cannot be decoded"));
}

/// A square whose vertices have the colour (1, 0, 1) of 255.
constexpr const char* kCompressedSquare =
    "RFJBQ08CAgEAAAACBAEAAQIAAgMBAwAJAwAAAwkCAAECAgQAAgICAQABAQADAwEwARADADSCiAQAAAAA/z8AAAABAQAD"
    "AwEgASADACCEhgIAAAAA/z8AAAABAQACAwFAAQANAAAAAAABAAAAAACAvwAAgL8AAAAAAAAAQA4AAAAAAAAAAAAAgD8O";

TEST_F(GltfDraco, SmallWholeNumbersAreScaled) {
    const int view = gltf_.view(from_base64(kCompressedSquare));
    gltf_.root["accessors"] = {
        {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
        {{"componentType", 5121}, {"count", 4}, {"type", "VEC4"}, {"normalized", true}}};
    gltf_.primitive() = {{"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
    gltf_.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"COLOR_0", 2}}}};
    const Scene scene = load();
    ASSERT_EQ(scene.vertex_colors.size(), 4u);
    expect_close(scene.vertex_colors[0], {1 / 255.0f, 0, 1 / 255.0f});
}

}  // namespace
}  // namespace nearlight::core
