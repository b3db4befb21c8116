// SPDX-License-Identifier: Apache-2.0
// Expected values come from Mitsuba 3.9.1 (ray_intersect, sample_ray, eval) unless they are plain arithmetic.
#include <numbers>

#include "host/image/image_io.h"
#include "host/scene/texture.h"
#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

struct Hit {
    Vec3 normal;  // of the triangle's front
    float u, v;   // v counts from the top, as in Mitsuba
};

// The surface of the first triangle that contains the point `p`, up to `tolerance`.
Hit surface_at(const Scene& scene, Vec3 p, float tolerance = 1e-3f) {
    for (const Triangle& triangle : scene.triangles) {
        const Vertex a = scene.vertices[triangle.v0];
        const Vertex b = scene.vertices[triangle.v1];
        const Vertex c = scene.vertices[triangle.v2];
        const Vec3 n = cross(b.position - a.position, c.position - a.position);
        if (is_zero(n) || std::abs(dot(normalize(n), p - a.position)) > tolerance) {
            continue;
        }
        const float wb = dot(cross(p - a.position, c.position - a.position), n) / dot(n, n);
        const float wc = dot(cross(b.position - a.position, p - a.position), n) / dot(n, n);
        if (wb >= -1e-4f && wc >= -1e-4f && wb + wc <= 1.0001f) {
            const float wa = 1.0f - wb - wc;
            return {normalize(n), wa * a.u + wb * b.u + wc * c.u, 1.0f - (wa * a.v + wb * b.v + wc * c.v)};
        }
    }
    ADD_FAILURE() << "nothing at " << p.x << " " << p.y << " " << p.z;
    return {};
}

void expect_hit(const Scene& scene, Vec3 p, Vec3 normal, float u, float v, float tolerance = 2e-3f) {
    const Hit hit = surface_at(scene, p);
    expect_near(hit.normal, normal, 0.05f);
    EXPECT_NEAR(hit.u, u, tolerance);
    EXPECT_NEAR(hit.v, v, tolerance);
}

TEST(MitsubaShape, RectangleAndCubeLieAsInMitsuba) {
    const SceneFiles files;
    const Scene rectangle = files.load_xml(shape("rectangle"));
    expect_hit(rectangle, {0.5f, -0.5f, 0}, {0, 0, 1}, 0.75f, 0.25f);
    const Scene cube = files.load_xml(shape("cube"));
    EXPECT_EQ(cube.triangles.size(), 12u);
    expect_hit(cube, {1, 0.5f, 0.75f}, {1, 0, 0}, 0.75f, 0.125f);
    expect_hit(cube, {-1, 0.5f, 0.75f}, {-1, 0, 0}, 0.75f, 0.875f);
    expect_hit(cube, {0.25f, 1, 0.75f}, {0, 1, 0}, 0.375f, 0.125f);
    expect_hit(cube, {0.25f, -1, 0.75f}, {0, -1, 0}, 0.875f, 0.625f);
    expect_hit(cube, {0.25f, 0.5f, 1}, {0, 0, 1}, 0.75f, 0.625f);
    expect_hit(cube, {0.25f, 0.5f, -1}, {0, 0, -1}, 0.25f, 0.625f);
}

float total_area(const Scene& scene) {
    double area = 0.0;  // of millions of triangles, of which a float would lose a part
    for (const Triangle& triangle : scene.triangles) {
        area += static_cast<double>(triangle_area(scene, triangle));
    }
    return static_cast<float>(area);
}

/// Many spheres share a few million triangles in proportion to their radii, and keep their areas.
TEST(MitsubaShape, ManySpheresHaveFewerFacets) {
    const auto sphere_at = [](int x, double radius) {
        return shape("sphere", "<point name='center' x='" + std::to_string(x) +
                                   "' y='0' z='0'/><float name='radius' value='" + std::to_string(radius) +
                                   "'/>");
    };
    std::string group = "<shape type='shapegroup' id='group'>" + sphere_at(0, 1) + "</shape>";
    std::string instances;
    for (int i = 0; i < 1999; ++i) {
        instances += "<shape type='instance'><ref id='group'/></shape>";
    }
    const SceneFiles files;
    const Scene few = files.load_xml(group + sphere_at(0, 4));
    const auto says_so = [](const Scene& scene) {
        return std::ranges::count(
            scene.notes, "spheres have fewer than 16128 facets each, because there are so many", &Note::text);
    };
    EXPECT_EQ(says_so(few), 0);
    EXPECT_EQ(few.triangles.size(), 16128u);
    const Scene many = files.load_xml(group + instances + sphere_at(0, 4));
    EXPECT_EQ(says_so(many), 1);
    // A sphere of 4 times the radius has 4 times the triangles, about.
    const std::size_t small = (many.triangles.size() - 7568) / 1999;
    EXPECT_EQ(small, 1848u);                                // 22 · 21 · 4
    EXPECT_EQ(many.triangles.size(), 1999 * small + 7568);  // 44 · 43 · 4
    EXPECT_NEAR(total_area(many) / (4 * kPi * (1999 + 16)), 1.0f, 1e-3f);
}

TEST(MitsubaShape, RoundShapesHaveTheirAreaAndFaceOutwards) {
    const SceneFiles files;
    const Scene sphere = files.load_xml(
        shape("sphere", "<point name='center' x='1' y='2' z='3'/><float name='radius' value='2'/>"));
    EXPECT_NEAR(total_area(sphere) / (16 * kPi), 1.0f, 1e-3f);
    for (const Triangle& t : sphere.triangles) {
        const Vec3 a = sphere.vertices[t.v0].position;
        const Vec3 n = cross(sphere.vertices[t.v1].position - a, sphere.vertices[t.v2].position - a);
        ASSERT_GT(dot(n, a - Vec3{1, 2, 3}), 0.0f);
    }
    const Scene disk = files.load_xml(shape("disk"));
    EXPECT_NEAR(total_area(disk) / kPi, 1.0f, 1e-3f);
    expect_hit(disk, {0, 0.5f, 0}, {0, 0, 1}, 0.5f, 0.25f, 5e-3f);
    const Scene cylinder = files.load_xml(shape("cylinder",
                                                "<point name='p0' value='0,0,1'/><point name='p1' "
                                                "value='0,3,1'/><float name='radius' value='0.5'/>"));
    EXPECT_NEAR(total_area(cylinder) / (3 * kPi), 1.0f, 1e-3f);
    const Aabb box = bounds(cylinder);
    expect_near(box.max, {0.5f, 3, 1.5f}, 2e-3f);
}

TEST(MitsubaShape, TransformsApplyInOrder) {
    const SceneFiles files;
    const Scene scene = files.load_xml(
        shape("rectangle", to_world("<rotate z='1' angle='90'/><scale x='2'/><translate value='1,2,3'/>")));
    expect_near(bounds(scene).min, {-1, 1, 3});
    expect_near(bounds(scene).max, {3, 3, 3});
    expect_hit(scene, {1.1f, 2.05f, 3}, {0, 0, 1}, 0.525f, 0.475f);
    const Scene matrix =
        files.load_xml(shape("rectangle", to_world("<matrix value='0 0 2  0 3 0  -4 0 0'/>")));
    expect_near(bounds(matrix).max, {0, 3, 4});
}

TEST(MitsubaShape, MirroredMeshesKeepMitsubasFront) {
    const SceneFiles files;
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    files.write("plain.obj", square + "f 1 2 3 4\n");
    files.write("normals.obj", square + "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n");
    const auto front = [&](const std::string& file, const std::string& body) {
        const Scene scene =
            files.load_xml(shape("obj", "<string name='filename' value='" + file + "'/>" + body));
        const Triangle t = scene.triangles[0];
        const Vec3 a = scene.vertices[t.v0].position;
        return normalize(cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a)).z;
    };
    const std::string mirror = to_world("<scale x='-1'/>");
    const std::string flat = "<boolean name='face_normals' value='true'/>";
    const std::string flip = "<boolean name='flip_normals' value='true'/>";
    EXPECT_EQ(front("plain.obj", ""), 1.0f);
    EXPECT_EQ(front("plain.obj", mirror), -1.0f);
    EXPECT_EQ(front("normals.obj", mirror), 1.0f);
    EXPECT_EQ(front("normals.obj", mirror + flat), -1.0f);
    EXPECT_EQ(front("plain.obj", flip), -1.0f);
    EXPECT_EQ(front("normals.obj", flip), -1.0f);
    for (const char* type : {"rectangle", "disk", "cube"}) {
        const Scene scene = files.load_xml(shape(type, mirror));
        const float z = std::string(type) == "cube" ? 1.0f : 0.0f;
        EXPECT_GT(surface_at(scene, {0.1f, 0.15f, z}).normal.z, 0.9f) << type;
    }
}

TEST(MitsubaShape, MirroredSpheresTurnInsideOutAndCylindersDoNot) {
    const SceneFiles files;
    const auto outward = [&](const char* type, const std::string& body) {
        const Scene scene = files.load_xml(shape(type, body));
        const Triangle t = scene.triangles[scene.triangles.size() / 2];
        const Vec3 a = scene.vertices[t.v0].position;
        const Vec3 n = cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a);
        return dot(n, {a.x, a.y, 0}) > 0.0f;
    };
    const std::string flip = "<boolean name='flip_normals' value='true'/>";
    for (const char* type : {"sphere", "cylinder"}) {
        EXPECT_TRUE(outward(type, "")) << type;
        const bool turns = std::string(type) == "sphere";
        EXPECT_EQ(outward(type, to_world("<scale value='1,1,-1'/>")), !turns) << type;
        EXPECT_TRUE(outward(type, to_world("<scale value='-1,-1,1'/>"))) << type;
        EXPECT_EQ(outward(type, flip + to_world("<scale value='-1'/>")), turns) << type;
    }
}

TEST(MitsubaShape, InstancesAreCopies) {
    const SceneFiles files;
    const Scene scene = files.load_xml("<shape type='shapegroup' id='g'>" + shape("rectangle") +
                                       shape("rectangle", to_world("<translate z='1'/>")) + "</shape>" +
                                       shape("instance", "<ref id='g'/>" + to_world("<translate x='5'/>")) +
                                       shape("instance", "<ref id='g'/>" + to_world("<translate x='-5'/>")));
    EXPECT_EQ(scene.triangles.size(), 8u);
    expect_near(bounds(scene).min, {-6, -1, 0});
    expect_near(bounds(scene).max, {6, 1, 1});
}

/// The normal at the middle of the instance's only shape, a square in z = 0 that faces +z before it is
/// placed.
TEST(MitsubaShape, InstancesThatMirrorLeaveNormalsOnTheirSide) {
    const SceneFiles files;
    files.write("bare.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    const std::string file = "<string name='filename' value='bare.obj'/>";
    const std::string flat = "<boolean name='face_normals' value='true'/>";
    const std::string mirror = to_world("<scale value='-1,1,1'/>");
    const auto faces_front = [&](const std::string& own) {
        const Scene scene = files.load_xml("<shape type='shapegroup' id='g'>" + own + "</shape>" +
                                           shape("instance", "<ref id='g'/>" + mirror));
        const Triangle t = scene.triangles[0];
        const Vec3 a = scene.vertices[t.v0].position;
        return cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a).z > 0.0f;
    };
    EXPECT_TRUE(faces_front(shape("rectangle")));
    EXPECT_TRUE(faces_front(shape("obj", file)));
    EXPECT_TRUE(faces_front(shape("obj", file + flat)));
    EXPECT_FALSE(faces_front(shape("obj", file + mirror))) << "its own transform turns it over";
    const Scene ball = files.load_xml("<shape type='shapegroup' id='g'>" + shape("sphere") + "</shape>" +
                                      shape("instance", "<ref id='g'/>" + mirror));
    EXPECT_GT(dot(ball.vertices[0].normal, ball.vertices[0].position), 0.0f);
}

TEST(MitsubaShape, FlatFacesOfCubesAndRectanglesStayOnTheirSide) {
    const SceneFiles files;
    const std::string body =
        "<boolean name='face_normals' value='true'/>" + to_world("<scale value='-1,1,1'/>");
    EXPECT_GT(surface_at(files.load_xml(shape("rectangle", body)), {0.1f, 0.15f, 0}).normal.z, 0.9f);
    EXPECT_GT(surface_at(files.load_xml(shape("cube", body)), {0.1f, 0.15f, 1}).normal.z, 0.9f);
}

// Writes a picture that is red at the top left, green at the top right, blue at the bottom left and white at
// the bottom right.
void write_corners(const SceneFiles& files) {
    Image image = make_image(2, 2, {"R", "G", "B"});
    image.values = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    write_image(files.path("corners.png"), image);
}

Vec3 color_at(const Scene& scene, Vec3 p) {
    const Hit hit = surface_at(scene, p);
    return texture_color(scene, scene.textures.at(0), hit.u, 1.0f - hit.v);
}

std::string textured_shape(const std::string& texture_body = "") {
    return "<bsdf type='diffuse'><texture name='reflectance' type='bitmap'><string name='filename' "
           "value='corners.png'/>" +
           texture_body + "</texture></bsdf>";
}

/// As in Mitsuba, u and v are then the barycentric coordinates of a triangle's second and third corner.
TEST(MitsubaTexture, MeshesWithoutCoordinatesHaveThoseOfTheirTriangles) {
    const SceneFiles files;
    write_corners(files);
    files.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    const std::string file = "<string name='filename' value='bare.obj'/>";
    const Scene textured = files.load_xml(shape("obj", file + textured_shape()));
    ASSERT_EQ(textured.vertices.size(), 6u);
    for (const Triangle& t : textured.triangles) {
        EXPECT_EQ(textured.vertices[t.v0].u, 0.0f);
        EXPECT_EQ(textured.vertices[t.v0].v, 1.0f);
        EXPECT_EQ(textured.vertices[t.v1].u, 1.0f);
        EXPECT_EQ(textured.vertices[t.v1].v, 1.0f);
        EXPECT_EQ(textured.vertices[t.v2].u, 0.0f);
        EXPECT_EQ(textured.vertices[t.v2].v, 0.0f);
    }
    EXPECT_EQ(files.load_xml(shape("obj", file)).vertices.size(), 4u) << "no texture needs them";
}

TEST(MitsubaTexture, ObjIsUprightAndFlippableAndRectangleAsInMitsuba) {
    const SceneFiles files;
    write_corners(files);
    files.write("square.obj",
                "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    const std::string obj = "<string name='filename' value='square.obj'/>" + textured_shape();
    const Scene upright = files.load_xml(shape("obj", obj));
    expect_near(color_at(upright, {0.25f, 0.75f, 0}), {1, 0, 0}, 0.02f);
    expect_near(color_at(upright, {0.75f, 0.75f, 0}), {0, 1, 0}, 0.02f);
    const Scene flipped = files.load_xml(shape("obj", obj + "<boolean name='flipTexCoords' value='false'/>"));
    expect_near(color_at(flipped, {0.25f, 0.25f, 0}), {1, 0, 0}, 0.02f);
    // Mitsuba shows the top row of the picture at the lower edge of a rectangle.
    const Scene rectangle = files.load_xml(shape("rectangle", textured_shape()));
    expect_near(color_at(rectangle, {-0.5f, -0.5f, 0}), {1, 0, 0}, 0.02f);
}

TEST(MitsubaTexture, ToUvAndOldScalesPlaceIt) {
    const SceneFiles files;
    write_corners(files);
    // (u, v) = (0.75, 0.25) of the rectangle looks up (0.25, 0.25) in Mitsuba's coordinates, which is at the
    // top left.
    const Scene moved = files.load_xml(
        shape("rectangle", textured_shape("<transform name='to_uv'><translate x='-0.5'/></transform>")));
    expect_near(color_at(moved, {0.5f, -0.5f, 0}), {1, 0, 0}, 0.02f);
    const Scene turned = files.load_xml(
        shape("rectangle", textured_shape("<transform name='to_uv'><rotate z='1' angle='90'/></transform>")));
    // (0.25, 0.25) becomes (−0.25, 0.25), which is at the top right.
    expect_near(color_at(turned, {-0.5f, -0.5f, 0}), {0, 1, 0}, 0.02f);
    const Scene old = files.load_xml(shape(
        "rectangle", textured_shape("<float name='uscale' value='2'/><float name='voffset' value='0.5'/>")));
    // (0.125, 0.25) becomes (0.25, 0.75), which is at the bottom left.
    expect_near(color_at(old, {-0.75f, -0.5f, 0}), {0, 0, 1}, 0.02f);
}

TEST(MitsubaTexture, CheckerboardHasColor0WhereBothHalvesAreTheSame) {
    const SceneFiles files;
    const Scene scene = files.load_xml(
        shape("rectangle",
              "<bsdf type='diffuse'><texture name='reflectance' type='checkerboard'>"
              "<rgb name='color0' value='1,0,0'/><rgb name='color1' value='0,1,0'/></texture></bsdf>"));
    expect_near(color_at(scene, {0.5f, 0.5f, 0}), {1, 0, 0});
    expect_near(color_at(scene, {-0.5f, -0.5f, 0}), {1, 0, 0});
    expect_near(color_at(scene, {-0.5f, 0.5f, 0}), {0, 1, 0});
}

TEST(MitsubaTexture, OneFileIsOneImageAndAMissingOneIsGrey) {
    const SceneFiles files;
    write_corners(files);
    const Scene shared =
        files.load_xml(shape("rectangle", textured_shape()) + shape("rectangle", textured_shape()));
    EXPECT_EQ(shared.images.size(), 1u);
    const std::string gone =
        shape("rectangle",
              "<bsdf type='diffuse'>\n<texture name='reflectance' type='bitmap'><string name='filename' "
              "value='gone.png'/></texture></bsdf>");
    const Scene scene = files.load_xml(gone);
    EXPECT_TRUE(has_note(scene, "scene.xml:3: texture is replaced"));
    expect_near(scene.materials[0].reflectance.value, {0.5f, 0.5f, 0.5f});
    EXPECT_EQ(scene.materials[0].reflectance.texture, -1);
    EXPECT_TRUE(mentions(file_error([&] { files.load_xml(gone, {.parameters = {}, .strict = true}); }),
                         "scene.xml:3"));
}

/// A sphere or cylinder of even radiance that shines outwards is one light; all others shine by their
/// triangles.
TEST(MitsubaShape, RoundLampsAreOneLightWhereTheyStayRound) {
    const SceneFiles files;
    const std::string lamp = "<emitter type='area'><rgb name='radiance' value='1 2 3'/></emitter>";
    const std::string place = "<point name='center' x='1' y='2' z='3'/><float name='radius' value='0.5'/>";
    const Scene scene =
        files.load_xml(shape("cube") + shape("sphere", lamp + place +
                                                           to_world("<scale value='2'/>"
                                                                    "<rotate x='1' angle='30'/>"
                                                                    "<translate y='1'/>")));
    ASSERT_EQ(scene.round_lamps.size(), 1u);
    const RoundLamp& found = scene.round_lamps[0];
    EXPECT_FLOAT_EQ(found.radius, 1.0f);
    EXPECT_GT(found.outer_radius, found.radius);
    EXPECT_LT(found.outer_radius, 1.001f * found.radius);
    EXPECT_EQ(found.first_triangle, 12u);
    EXPECT_EQ(found.first_triangle + found.triangle_count, scene.triangles.size());
    const double angle = std::numbers::pi / 6;
    expect_near(found.center,
                {2, static_cast<float>(4 * std::cos(angle) - 6 * std::sin(angle) + 1),
                 static_cast<float>(4 * std::sin(angle) + 6 * std::cos(angle))},
                1e-5f);
    const Scene tube = files.load_xml(
        shape("cylinder", lamp +
                              "<point name='p0' x='1' y='2' z='3'/><point name='p1' x='1' y='2' z='7'/>"
                              "<float name='radius' value='0.5'/>" +
                              to_world("<scale x='2' y='2' z='3'/>")));
    ASSERT_EQ(tube.round_lamps.size(), 1u);
    expect_near(tube.round_lamps[0].center, {2, 4, 9}, 1e-5f);
    expect_near(tube.round_lamps[0].axis, {0, 0, 12}, 1e-5f);
    EXPECT_FLOAT_EQ(tube.round_lamps[0].radius, 1.0f);
    EXPECT_LT(tube.round_lamps[0].outer_radius, 1.001f);
    for (const std::string& other :
         {shape("sphere", place), shape("cube", lamp), shape("cylinder", lamp + to_world("<scale x='2'/>")),
          shape("cylinder", lamp + to_world("<matrix value='1 0 0 0 0 1 0.1 0 0 0 1 0 0 0 0 1'/>")),
          shape("sphere", lamp + to_world("<scale x='-1'/>")),
          shape("sphere", lamp + "<boolean name='flip_normals' value='true'/>"),
          shape("sphere", "<emitter type='area'><texture name='radiance' type='checkerboard'/></emitter>")}) {
        EXPECT_TRUE(files.load_xml(other).round_lamps.empty()) << other;
    }
}

}  // namespace
}  // namespace nearlight::core
