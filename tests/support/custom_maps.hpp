#pragma once

#include <echinus/custom_map.hpp>
#include <echinus/exact_map.hpp>

#include <utility>

namespace echinus::test {

/// A ball as a custom map.
class AnalyticBall final : public CustomMap {
  public:
    explicit AnalyticBall(float radius, Vec3f centre = {}) : radius_(radius), centre_(centre) {}

    void contains_batch(std::span<const Vec3f> points,
                        std::span<std::uint8_t> inside) const noexcept override {
        for (std::size_t i = 0; i < points.size(); ++i)
            inside[i] = length(points[i] - centre_) < radius_ ? 1 : 0;
    }
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const noexcept override {
        for (std::size_t i = 0; i < points.size(); ++i) contacts[i] = contact_of(points[i], margin);
    }

  private:
    Contact contact_of(const Vec3f& point, float margin) const {
        Contact contact;
        contact.point = point;
        const Vec3f from_centre = point - centre_;
        const float distance = length(from_centre);
        const float depth = radius_ - distance;
        if (!(depth >= -margin)) return contact;
        contact.normal = distance > 0 ? from_centre * (1 / distance) : Vec3f{0, 0, 1};
        contact.point = centre_ + contact.normal * radius_;
        contact.depth = depth;
        contact.inside = depth > 0;
        return contact;
    }

    float radius_;
    Vec3f centre_;
};

/// An exact map that is asked as if it were the user's.
class AskedExactMap final : public CustomMap {
  public:
    explicit AskedExactMap(ExactMap map) : map_(std::move(map)) {}
    void contains_batch(std::span<const Vec3f> points,
                        std::span<std::uint8_t> inside) const noexcept override {
        echinus::contains_batch(map_.view(), points, inside);
    }
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const noexcept override {
        echinus::contacts_batch(map_.view(), points, margin, contacts);
    }

  private:
    ExactMap map_;
};

/// Gives every particle the same answer.
class ConstantAnswer final : public CustomMap {
  public:
    explicit ConstantAnswer(const Contact& answer) : answer_(answer) {}

    void contains_batch(std::span<const Vec3f>, std::span<std::uint8_t> inside) const noexcept override {
        for (std::uint8_t& one : inside) one = answer_.inside ? 255 : 0;
    }
    void contacts_batch(std::span<const Vec3f>, float, std::span<Contact> contacts) const noexcept override {
        for (Contact& contact : contacts) contact = answer_;
    }

  private:
    Contact answer_;
};

/// Every particle is inside, and there is no way out.
class StuckInside final : public CustomMap {
  public:
    void contains_batch(std::span<const Vec3f>, std::span<std::uint8_t> inside) const noexcept override {
        for (std::uint8_t& one : inside) one = 1;
    }
    void contacts_batch(std::span<const Vec3f> points, float,
                        std::span<Contact> contacts) const noexcept override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            contacts[i] = {};
            contacts[i].point = points[i];
            contacts[i].inside = true;
        }
    }
};

} // namespace echinus::test
