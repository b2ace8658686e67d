#include "geometry/parallel.hpp"
#include "render/image.hpp"
#include "render/intersector.hpp"
#include "render/painted_surface.hpp"
#include "render/tracer.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <algorithm>
#include <mutex>

namespace echinus {

namespace {

void require_valid_options(const RenderOptions& options) {
    require_drawable(options.width, options.height);
    if (options.samples < 1 || options.samples > RenderOptions::kMaxSampleCount) {
        throw Error(ErrorCode::InvalidOptions, std::to_string(options.samples) +
                                                   " samples per pixel: give 1 to " +
                                                   std::to_string(RenderOptions::kMaxSampleCount));
    }
}

/// Counts finished rows and reports them to the caller's callback, one thread at a time.
class RowProgress {
  public:
    explicit RowProgress(const RenderOptions& options)
        : callback_(options.progress), row_count_(options.height) {}

    void finish_row() {
        if (!callback_) return;
        const std::lock_guard lock(mutex_);
        ++finished_;
        callback_(static_cast<double>(finished_) / row_count_);
    }

  private:
    const std::function<void(double)>& callback_;
    std::mutex mutex_;
    std::uint32_t row_count_, finished_ = 0;
};

void draw_row(const Tracer& tracer, std::uint32_t y, Image& image) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
        const auto pixel = to_srgb8(compress_highlights(tracer.pixel(x, y)));
        std::copy(pixel.begin(), pixel.end(), &image.rgb[3 * (std::size_t{y} * image.width + x)]);
    }
}

} // namespace

Image render(std::span<const RenderedObject> objects, const Camera& camera, const RenderOptions& options) {
    require_valid_options(options);
    const PaintedSurface surface = paint(objects);
    const Intersector intersector(surface.mesh);
    const Tracer tracer(surface, intersector, camera, options);

    Image image{options.width, options.height, {}};
    image.rgb.resize(std::size_t{3} * options.width * options.height);
    RowProgress progress(options);
    parallel_for(options.height, options.thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            draw_row(tracer, static_cast<std::uint32_t>(y), image);
            progress.finish_row();
        }
    });
    return image;
}

} // namespace echinus
