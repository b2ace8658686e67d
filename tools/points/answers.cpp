
#include "output.hpp"
#include "points/points.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>

using echinus::Contact;
using echinus::Vec3d;
using echinus::Vec3f;

namespace {

/// Calls use() with the point in the frame of the mesh's file.
template <typename Use>
void in_file(const Vec3f& point, const Vec3d& origin, const Use& use) {
    if (origin == Vec3d{})
        use(point);
    else
        use(Vec3d(point) + origin);
}

/// -1 if the map does not know the face.
std::int32_t number_in_file(std::uint32_t face) {
    return static_cast<std::int32_t>(face);
}

class NpyAnswers final : public AnswerWriter {
  public:
    NpyAnswers(const std::filesystem::path& target, std::uint64_t count, AnswerFields fields)
        : output_(target), origin_(fields.origin) {
        output_.write(
            format_npy_header("[('inside', '|u1'), ('depth', '<f4'), ('normal', '<f4', (3,)), ('point', '" +
                                  std::string(origin_ == Vec3d{} ? "<f4" : "<f8") +
                                  "', (3,)), ('face', '<i4'), ('certain', '|u1')" +
                                  std::string(fields.signed_distance ? ", ('signed_distance', '<f4')" : "") +
                                  (fields.winding_number ? ", ('winding_number', '<f4')" : "") + "]",
                              count));
    }

    void write(const Answers& answers) override {
        records_.clear();
        for (std::size_t i = 0; i < answers.contacts.size(); ++i) {
            const Contact& contact = answers.contacts[i];
            append(static_cast<std::uint8_t>(contact.inside));
            append(contact.depth);
            append(contact.normal);
            in_file(contact.point, origin_, [&](const auto& point) { append(point); });
            append(number_in_file(contact.face));
            append(static_cast<std::uint8_t>(contact.certain));
            if (!answers.signed_distances.empty()) append(answers.signed_distances[i]);
            if (!answers.winding_numbers.empty()) append(answers.winding_numbers[i]);
        }
        output_.write(records_);
    }

    void finish() override { output_.commit(); }

  private:
    template <typename T>
    void append(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        records_.append(bytes, sizeof(T));
    }

    Output output_;
    Vec3d origin_;
    std::string records_;
};

class CsvAnswers final : public AnswerWriter {
  public:
    CsvAnswers(const std::filesystem::path& target, AnswerFields fields)
        : output_(target), origin_(fields.origin) {
        output_.write(
            std::string("inside,depth,normal_x,normal_y,normal_z,point_x,point_y,point_z,face,certain") +
            (fields.signed_distance ? ",signed_distance" : "") +
            (fields.winding_number ? ",winding_number" : "") + "\n");
    }

    void write(const Answers& answers) override {
        lines_.clear();
        for (std::size_t i = 0; i < answers.contacts.size(); ++i) {
            const Contact& contact = answers.contacts[i];
            const Vec3f& normal = contact.normal;
            fmt::format_to(std::back_inserter(lines_), "{},{},{},{},{}", contact.inside ? 1 : 0,
                           contact.depth, normal.x, normal.y, normal.z);
            in_file(contact.point, origin_, [&](const auto& point) {
                fmt::format_to(std::back_inserter(lines_), ",{},{},{}", point.x, point.y, point.z);
            });
            fmt::format_to(std::back_inserter(lines_), ",{},{}", number_in_file(contact.face),
                           contact.certain ? 1 : 0);
            for (const std::span<const float> more : {answers.signed_distances, answers.winding_numbers})
                if (!more.empty()) fmt::format_to(std::back_inserter(lines_), ",{}", more[i]);
            lines_ += '\n';
        }
        output_.write(lines_);
    }

    void finish() override { output_.commit(); }

  private:
    Output output_;
    Vec3d origin_;
    std::string lines_;
};

} // namespace

std::unique_ptr<AnswerWriter> open_answers(const std::filesystem::path& target, TableFormat format,
                                           std::uint64_t count, AnswerFields fields) {
    if (format == TableFormat::Csv) return std::make_unique<CsvAnswers>(target, fields);
    return std::make_unique<NpyAnswers>(target, count, fields);
}
