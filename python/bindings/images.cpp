// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "host/base/words.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/settings.h"

namespace nearlight::python {
namespace {

using SharedImage = std::shared_ptr<Image>;

/// Some channels of an image in its own memory: the first, and the way from one to the next.
struct ChannelRun {
    py::ssize_t first = 0;
    py::ssize_t step = 1;
    py::ssize_t count = 0;
};

/// An array on the memory of `image`, which lives as long as the array. A single channel has no axis of its
/// own.
py::array view_of(const SharedImage& image, ChannelRun run, bool drops_single) {
    constexpr auto kFloat = static_cast<py::ssize_t>(sizeof(float));
    const auto channels = std::ssize(image->channels);
    std::vector<py::ssize_t> shape{image->height, image->width, run.count};
    std::vector<py::ssize_t> strides{kFloat * channels * image->width, kFloat * channels, kFloat * run.step};
    if (drops_single && run.count == 1) {
        shape.pop_back();
        strides.pop_back();
    }
    return {py::dtype::of<float>(), shape, strides, image->values.data() + run.first, py::cast(image)};
}

/// The channels of a layer, if they lie evenly.
std::optional<ChannelRun> run_of(const Image& image, const std::string& layer) {
    std::vector<py::ssize_t> indices;
    for (std::size_t i = 0; i < image.channels.size(); ++i) {
        if (layer_of(image.channels[i]) == layer) {
            indices.push_back(static_cast<py::ssize_t>(i));
        }
    }
    if (indices.empty()) {
        return std::nullopt;
    }
    const py::ssize_t step = indices.size() > 1 ? indices[1] - indices[0] : 1;
    for (std::size_t i = 1; i < indices.size(); ++i) {
        if (indices[i] - indices[i - 1] != step) {
            return std::nullopt;
        }
    }
    return ChannelRun{indices.front(), step, std::ssize(indices)};
}

py::array layer_array(const SharedImage& image, const std::string& name) {
    if (const auto run = run_of(*image, name)) {
        return view_of(image, *run, true);
    }
    const auto copy = std::make_shared<Image>(layer(*image, name));
    return view_of(copy, {0, 1, std::ssize(copy->channels)}, true);
}

std::vector<std::string> default_channels(py::ssize_t count) {
    if (count == 1) {
        return {"Y"};
    }
    if (count == 3 || count == 4) {
        return count == 3 ? std::vector<std::string>{"R", "G", "B"}
                          : std::vector<std::string>{"R", "G", "B", "A"};
    }
    throw Error(ErrorKind::invalid_argument,
                "an image of " + std::to_string(count) + " channels needs their names", "channels");
}

/// A copy of an array of numbers, in any order and of any real type.
SharedImage image_of(const py::object& values, const std::optional<std::vector<std::string>>& channels) {
    const FloatArray floats = to_floats("values", values);
    if (floats.ndim() != 2 && floats.ndim() != 3) {
        throw Error(ErrorKind::invalid_argument,
                    "values have the shape " + shown(floats.attr("shape")) +
                        "; it must be (height, width) or (height, width, channels)",
                    "values");
    }
    if (floats.size() == 0) {
        throw Error(ErrorKind::invalid_argument,
                    "values have the shape " + shown(floats.attr("shape")) +
                        "; an image needs at least one pixel and one channel",
                    "values");
    }
    const py::ssize_t count = floats.ndim() == 3 ? floats.shape(2) : 1;
    auto image = std::make_shared<Image>();
    image->width = static_cast<int>(floats.shape(1));
    image->height = static_cast<int>(floats.shape(0));
    image->channels = channels ? *channels : default_channels(count);
    if (std::ssize(image->channels) != count) {
        throw Error(ErrorKind::invalid_argument,
                    "values of the shape " + shown(floats.attr("shape")) + " do not fit " +
                        std::to_string(image->channels.size()) + " channels",
                    "channels");
    }
    image->values.assign(floats.data(), floats.data() + floats.size());
    return image;
}

std::string text_of(const Image& image) {
    return "<nearlight.Image " + std::to_string(image.width) + "x" + std::to_string(image.height) + ": " +
           core::joined(layer_names(image), ", ") + ">";
}

void write(const Image& image, const py::object& file, const py::object& options, const py::kwargs& fields) {
    const std::filesystem::path path = to_path(file);
    const WriteOptions chosen = settings_of<WriteOptions>("write", "options", options, fields);
    without_gil([&] {
        write_image(path, image, chosen);
        return true;
    });
}

std::string text_of(const Difference& difference) {
    return "Difference(rmse=" + shown(py::float_(difference.rmse)) +
           ", relative_mse=" + shown(py::float_(difference.relative_mse)) +
           ", mean_ratio=" + shown(py::float_(difference.mean_ratio)) +
           ", flip=" + shown(py::float_(difference.flip)) +
           ", non_finite=" + std::to_string(difference.non_finite) + ")";
}

void add_image_class(py::module_& module) {
    py::class_<Image, SharedImage>(
        module, "Image",

        "Pixels of floats with named channels, the top row first.\n\n"
        "values: an array of the shape (height, width, channels) or (height, width), which is copied.\n"
        "channels: their names, as in OpenEXR: 'R', 'indirect.R'; None: Y, R G B or R G B A, by their "
        "number.")
        .def(py::init(&image_of), py::arg("values"), py::arg("channels") = py::none(),
             "__init__(self, values, channels=None)\n--\n\n")
        .def_readonly("width", &Image::width, "pixels")
        .def_readonly("height", &Image::height, "pixels")
        .def_readonly("channels", &Image::channels, "the names of the channels")
        .def_property_readonly(
            "layers", [](const Image& image) { return layer_names(image); },
            "the names of the layers; 'beauty' stands for R, G and B")
        .def_property_readonly(
            "values",
            [](const SharedImage& image) {
                return view_of(image, {0, 1, std::ssize(image->channels)}, false);
            },
            "all channels as an array (height, width, channels) of float32 on the image's own memory")
        .def("__getitem__", &layer_array, py::arg("layer"),
             "__getitem__(self, layer)\n--\n\n"
             "A layer as an array on the image's own memory: (height, width, channels), or (height, width) "
             "if it\n"
             "has a single channel. A layer whose channels do not lie evenly is copied.")
        .def("__contains__",
             [](const Image& image, const std::string& name) {
                 const std::vector<std::string> names = layer_names(image);
                 return std::ranges::find(names, name) != names.end();
             })
        .def("write", &write, py::arg("file"), py::arg("options") = py::none(),
             "write(self, file, options=None, **fields)\n--\n\n"
             "Writes .exr with all channels, or .png through the sRGB curve; fields are those of "
             "WriteOptions.")
        .def("_repr_png_",
             [](const py::object& self) {
                 return py::module_::import("nearlight._notebook").attr("png")(self);
             })
        .def("__repr__", [](const Image& image) { return text_of(image); });
}

void add_reader(py::module_& module, const char* name, Image (*read)(const std::filesystem::path&),
                const char* help) {
    module.def(
        name,
        [read](const py::object& file) {
            const std::filesystem::path path = to_path(file);
            return std::make_shared<Image>(without_gil([&] { return read(path); }));
        },
        py::arg("file"), help);
}

}  // namespace

void add_images(py::module_& module) {
    add_image_class(module);
    py::class_<Difference>(module, "Difference", "How much a picture differs from a reference.")
        .def_readonly("rmse", &Difference::rmse, "root of the mean square over pixels and R, G, B")
        .def_readonly("relative_mse", &Difference::relative_mse,
                      "mean of (a - b)² / (b² + 0.01), b the reference")
        .def_readonly("mean_ratio", &Difference::mean_ratio,
                      "mean luminance divided by that of the reference")
        .def_readonly("flip", &Difference::flip,
                      "mean FLIP of the pictures, clamped to [0, 1]: 0 (equal) to 1")
        .def_readonly("non_finite", &Difference::non_finite,
                      "pixels that are left out: NaN or infinity in either")
        .def("__repr__", [](const Difference& difference) { return text_of(difference); });
    add_reader(
        module, "read_image", read_image,
        "read_image(file)\n--\n\n"
        "Reads EXR, PNG, JPEG, HDR, TIFF, Targa, BMP, GIF, WebP, PSD, DDS, PNM and PFM, with the values of "
        "the file.");
    add_reader(module, "read_linear_image", read_linear_image,
               "read_linear_image(file)\n--\n\n"
               "Reads a picture with linear values, as renders have them: the sRGB curve of PNG and JPEG is "
               "removed.");
    module.def(
        "automatic_exposure",
        [](const SharedImage& image) { return without_gil([&] { return automatic_exposure(*image); }); },
        py::arg("image"),
        "automatic_exposure(image)\n--\n\n"
        "The exposure in stops at which a picture with linear values looks right on a screen; for "
        "Image.write() of pictures whose scene has_open_exposure.");
    module.def(
        "diff",
        [](const SharedImage& image, const SharedImage& reference, const std::string& layer) {
            return without_gil([&] { return diff(*image, *reference, layer); });
        },
        py::arg("image"), py::arg("reference"), py::arg("layer") = "beauty",
        "diff(image, reference, layer='beauty')\n--\n\n"
        "Compares a layer of a picture with that of a reference of the same size, both linear: a "
        "Difference.");
    module.def(
        "diff_map",
        [](const SharedImage& image, const SharedImage& reference, const std::string& layer) {
            return std::make_shared<Image>(without_gil([&] { return diff_map(*image, *reference, layer); }));
        },
        py::arg("image"), py::arg("reference"), py::arg("layer") = "beauty",
        "diff_map(image, reference, layer='beauty')\n--\n\n"
        "The FLIP error of each pixel as a picture, from dark (equal) to bright.");
}

}  // namespace nearlight::python
