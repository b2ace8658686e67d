#include "support/expectations.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <gtest/gtest.h>

#include <limits>

using namespace echinus;

namespace {

const TriangleMesh kBox = make_box({1, 1, 1});
const Camera kCamera = camera_for(kBox.vertices, View{}, 1);

RenderOptions tiny_options() {
    RenderOptions options;
    options.width = options.height = 8;
    options.samples = 1;
    return options;
}

void expect_error(ErrorCode code, const std::vector<RenderedObject>& objects, const RenderOptions& options) {
    test::expect_error(code, "", [&] { render(objects, kCamera, options); });
}

RenderedObject object_with(const TriangleMesh& mesh) {
    RenderedObject object;
    object.mesh = mesh;
    return object;
}

} // namespace

TEST(RenderErrors, NothingToDraw) {
    expect_error(ErrorCode::InvalidMesh, {}, tiny_options());
    expect_error(ErrorCode::InvalidMesh, {object_with({})}, tiny_options());
}

TEST(RenderErrors, AMeshOfFacesWithoutArea) {
    const TriangleMesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 0, 1}}};
    const TriangleMesh point{{{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}, {{0, 1, 2}}};
    expect_error(ErrorCode::InvalidMesh, {object_with(line)}, tiny_options());
    expect_error(ErrorCode::InvalidMesh, {object_with(point)}, tiny_options());
    expect_error(ErrorCode::InvalidMesh, {object_with(kBox), object_with(line)}, tiny_options());
}

TEST(RenderErrors, AMeshThatIsNotValid) {
    TriangleMesh broken = kBox;
    broken.vertices[broken.faces[3][0]].y = std::numeric_limits<float>::quiet_NaN();
    expect_error(ErrorCode::InvalidMesh, {object_with(broken)}, tiny_options());
    broken = kBox;
    broken.faces[2][1] = 1'000'000;
    expect_error(ErrorCode::InvalidMesh, {object_with(broken)}, tiny_options());
}

TEST(RenderErrors, SizesBeyondAllSense) {
    for (const auto& [width, height] : {std::pair{0U, 8U}, std::pair{8U, 0U}, std::pair{100'000U, 8U},
                                        std::pair{16'384U, 16'384U}, std::pair{0xFFFFFFFFU, 0xFFFFFFFFU}}) {
        RenderOptions options = tiny_options();
        options.width = width;
        options.height = height;
        expect_error(ErrorCode::InvalidOptions, {object_with(kBox)}, options);
    }
}

TEST(RenderErrors, SampleCountsBeyondAllSense) {
    for (std::uint32_t samples : {0U, RenderOptions::kMaxSampleCount + 1}) {
        RenderOptions options = tiny_options();
        options.samples = samples;
        expect_error(ErrorCode::InvalidOptions, {object_with(kBox)}, options);
    }
}

TEST(RenderErrors, PaintThatDoesNotFitTheMesh) {
    RenderedObject object = object_with(kBox);
    object.face_colours.resize(5);
    expect_error(ErrorCode::InvalidOptions, {object}, tiny_options());
    object = object_with(kBox);
    object.marked_faces = {12};
    expect_error(ErrorCode::InvalidOptions, {object}, tiny_options());
    object = object_with(kBox);
    object.crease_angle_deg = std::numeric_limits<double>::quiet_NaN();
    expect_error(ErrorCode::InvalidOptions, {object}, tiny_options());
    object = object_with(kBox);
    object.wire_width_px = -1;
    expect_error(ErrorCode::InvalidOptions, {object}, tiny_options());
}

TEST(RenderErrors, AnExceptionOfTheProgressCallbackStopsTheWork) {
    RenderOptions options = tiny_options();
    options.progress = [](double) { throw std::runtime_error("enough"); };
    EXPECT_THROW(render(std::vector{object_with(kBox)}, kCamera, options), std::runtime_error);
}
