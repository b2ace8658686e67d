#include "points/answers.hpp"

#include "output.hpp"
#include "points/npy_header.hpp"

#include <fmt/format.h>

#include <cstring>
#include <iterator>
#include <string>

using echinus::Contact;
using echinus::Vec3f;

namespace {

class NpyAnswers final : public AnswerWriter {
  public:
    NpyAnswers(const std::filesystem::path& target, std::uint64_t count) : output_(target) {
        output_.write(format_npy_header("[('inside', '|u1'), ('depth', '<f4'), ('normal', '<f4', (3,)), "
                                        "('point', '<f4', (3,)), ('face', '<i4'), "
                                        "('certain', '|u1')]",
                                        count));
    }

    void write(std::span<const Contact> contacts) override {
        records_.clear();
        for (const Contact& contact : contacts) {
            append(static_cast<std::uint8_t>(contact.inside));
            append(contact.depth);
            append(contact.normal);
            append(contact.point);
            append(contact.face);
            append(static_cast<std::uint8_t>(contact.certain));
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
    std::string records_;
};

class CsvAnswers final : public AnswerWriter {
  public:
    explicit CsvAnswers(const std::filesystem::path& target) : output_(target) {
        output_.write("inside,depth,normal_x,normal_y,normal_z,point_x,point_y,point_z,face,certain\n");
    }

    void write(std::span<const Contact> contacts) override {
        lines_.clear();
        for (const Contact& contact : contacts) {
            const Vec3f &normal = contact.normal, &point = contact.point;
            fmt::format_to(std::back_inserter(lines_), "{},{},{},{},{},{},{},{},{},{}\n",
                           contact.inside ? 1 : 0, contact.depth, normal.x, normal.y, normal.z, point.x,
                           point.y, point.z, contact.face, contact.certain ? 1 : 0);
        }
        output_.write(lines_);
    }

    void finish() override { output_.commit(); }

  private:
    Output output_;
    std::string lines_;
};

} // namespace

std::unique_ptr<AnswerWriter> open_answers(const std::filesystem::path& target, TableFormat format,
                                           std::uint64_t count) {
    if (format == TableFormat::Csv) return std::make_unique<CsvAnswers>(target);
    return std::make_unique<NpyAnswers>(target, count);
}
