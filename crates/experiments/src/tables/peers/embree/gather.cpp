// A ray caster of metaballs on Embree 3, for `metaball tables peers` alone: balls are user geometry, a
// query gathers those that reach a ray, and the search for the first root is that of
// crates/fbvh/src/trace/certified/polynomial.rs in f64, without its bounds of rounding.
//
// gather THRESHOLD WIDTH HEIGHT THREADS WINDOW, in a folder with
//   balls.f32  x, y, z, R, q of each ball
//   rays.f32   origin, t_min, direction, t_max of each ray, row by row from the top left
// writes hits.npy (height × width × 4: t, normal) and prints its clocks in milliseconds. WINDOW is the
// part of a ray that is gathered at once, in mean support radii; 0 gathers the whole ray. --version prints
// Embree's.

#if !__has_include(<embree3/rtcore.h>)
#error "Embree 3 is not installed"
#endif

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <vector>

namespace {

struct Ball {
    float x, y, z, radius, strength;
};

struct Ray {
    float origin[3], t_min, direction[3], t_max;
};

struct Hit {
    float t, normal[3];
};

constexpr Hit MISS{std::numeric_limits<float>::infinity(), {0, 0, 0}};
constexpr Hit UNDECIDED{std::numeric_limits<float>::quiet_NaN(), {0, 0, 0}};

// The balls that reach an interval of a ray, side by side: v = 1 − r²/R² = constant + linear·t − square·t²
// with t from the interval's start.
struct Chords {
    double start = 0.0;
    std::vector<unsigned> balls;
    std::vector<double> constant, linear, square, strength;

    void clear(double at) {
        start = at;
        balls.clear();
        constant.clear();
        linear.clear();
        square.clear();
        strength.clear();
    }

    void add(const Ball &ball, unsigned index, const Ray &ray, double end) {
        double along = 0.0, distance = 0.0, length = 0.0;
        const float center[3] = {ball.x, ball.y, ball.z};
        for (int axis = 0; axis < 3; ++axis) {
            const double direction = ray.direction[axis];
            const double offset = double(center[axis]) - ray.origin[axis] - start * direction;
            along += offset * direction;
            distance += offset * offset;
            length += direction * direction;
        }
        const double inverse = 1.0 / (double(ball.radius) * ball.radius);
        const double nearest = std::clamp(along / length, 0.0, end - start);
        if (distance - nearest * (2.0 * along - nearest * length) >= double(ball.radius) * ball.radius) {
            return;
        }
        balls.push_back(index);
        constant.push_back(1.0 - distance * inverse);
        linear.push_back(2.0 * along * inverse);
        square.push_back(length * inverse);
        strength.push_back(ball.strength);
    }
};

using Quartic = std::array<double, 5>;

// Bernstein coefficients above and below F − T on an interval; the same where no support ends in it.
struct Enclosure {
    Quartic upper, lower;
    bool exact;

    Enclosure(const Chords &chords, double threshold, double start, double end) {
        double most[5] = {}, least[5] = {};
        const double middle = 0.5 * (start + end), product = start * end;
        const size_t count = chords.balls.size();
        for (size_t ball = 0; ball < count; ++ball) {
            const double a = chords.constant[ball], b = chords.linear[ball], c = chords.square[ball];
            const double v0 = a + b * start - c * start * start;
            const double v1 = a + b * middle - c * product;
            const double v2 = a + b * end - c * end * end;
            const double covers = v0 >= 0.0 && v2 >= 0.0 ? 1.0 : 0.0;
            const double q = chords.strength[ball];
            const double w0 = std::max(v0, 0.0), w1 = std::max(v1, 0.0), w2 = std::max(v2, 0.0);
            const double terms[5] = {q * w0 * w0, q * w0 * w1, q * (2.0 * w1 * w1 + w0 * w2) / 3.0,
                                     q * w1 * w2, q * w2 * w2};
            for (int k = 0; k < 5; ++k) {
                most[k] += terms[k];
                least[k] += covers * terms[k];
            }
        }
        exact = true;
        for (int k = 0; k < 5; ++k) {
            upper[k] = most[k] - threshold;
            lower[k] = least[k] - threshold;
            exact = exact && most[k] == least[k];
        }
    }

    bool is_below() const {
        return std::all_of(upper.begin(), upper.end(), [](double c) { return c < 0.0; });
    }

    bool changes_sign_once() const {
        int below = 0, above = 0;
        while (below < 5 && upper[below] < 0.0) ++below;
        while (above < 5 && lower[4 - above] > 0.0) ++above;
        return below >= 1 && above >= 1 && below + above >= 4;
    }
};

double value_at(Quartic c, double x) {
    for (int level = 4; level > 0; --level) {
        for (int k = 0; k < level; ++k) c[k] += x * (c[k + 1] - c[k]);
    }
    return c[0];
}

// The part of an interval in which a polynomial that is negative at its start stays so: Bézier clipping
// from one side.
double negative_until(Quartic c) {
    double start = 0.0;
    for (int clip = 0; clip < 4; ++clip) {
        double steepest = -std::numeric_limits<double>::infinity();
        bool reaches = false;
        for (int k = 1; k < 5; ++k) {
            steepest = std::max(steepest, (c[k] - c[0]) / k);
            reaches = reaches || c[k] >= 0.0;
        }
        if (!reaches) return 1.0;
        const double x = std::clamp(-c[0] / (4.0 * steepest), 0.0, 1.0) * (1.0 - 1e-9);
        start += x * (1.0 - start);
        if (x < 0.05) break;
        for (int level = 4; level > 0; --level) {
            for (int k = 0; k < level; ++k) c[k] += x * (c[k + 1] - c[k]);
        }
    }
    return start;
}

struct Scene {
    std::vector<Ball> balls;
    double threshold;

    // F − T and the gradient of F at t of the ray, over the gathered balls.
    double excess(const Ray &ray, const Chords &chords, double t, double gradient[3]) const {
        double sum = -threshold, point[3];
        for (int axis = 0; axis < 3; ++axis) {
            point[axis] = ray.origin[axis] + (chords.start + t) * ray.direction[axis];
            gradient[axis] = 0.0;
        }
        for (const unsigned index : chords.balls) {
            const Ball &ball = balls[index];
            const double x = ball.x - point[0], y = ball.y - point[1], z = ball.z - point[2];
            const double inverse = 1.0 / (double(ball.radius) * ball.radius);
            const double v = std::max(0.0, 1.0 - (x * x + y * y + z * z) * inverse);
            const double pull = 4.0 * ball.strength * v * inverse;
            sum += ball.strength * v * v;
            gradient[0] += pull * x;
            gradient[1] += pull * y;
            gradient[2] += pull * z;
        }
        return sum;
    }

    Hit hit_at(const Ray &ray, const Chords &chords, double t) const {
        double gradient[3];
        excess(ray, chords, t, gradient);
        const double length = std::hypot(gradient[0], gradient[1], gradient[2]);
        Hit hit{float(chords.start + t), {}};
        for (int axis = 0; axis < 3; ++axis) {
            hit.normal[axis] = length > 0.0 ? float(-gradient[axis] / length) : -ray.direction[axis];
        }
        return hit;
    }

    // The only root between two t, by Newton's steps within a bracket.
    Hit refine(const Ray &ray, const Chords &chords, double low, double high) const {
        double t = 0.5 * (low + high);
        const double tiny = 1e-9 * (high - low);
        for (int step = 0; step < 60; ++step) {
            double gradient[3];
            const double value = excess(ray, chords, t, gradient);
            (value >= 0.0 ? high : low) = t;
            double slope = 0.0;
            for (int axis = 0; axis < 3; ++axis) slope += gradient[axis] * ray.direction[axis];
            double next = t - value / slope;
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            const bool is_there = std::abs(next - t) <= tiny;
            t = next;
            if (is_there) break;
        }
        return hit_at(ray, chords, t);
    }

    // The first root on an interval of the ray, front to back; a miss where there is none.
    Hit first_root(const Ray &ray, const Chords &chords, double length, bool starts) const {
        constexpr int MOST_INTERVALS = 200;
        if (chords.balls.empty()) return MISS;
        double start = 0.0, end = length;
        for (int count = 0; count < MOST_INTERVALS; ++count) {
            const Enclosure bounds(chords, threshold, start, end);
            if (bounds.upper[0] >= 0.0) {
                if (count > 0 || !starts) return hit_at(ray, chords, start);
                return Hit{0.0f, {-ray.direction[0], -ray.direction[1], -ray.direction[2]}};
            }
            const double width = end - start;
            if (bounds.is_below()) {
                if (end >= length) return MISS;
                start = end;
                end = std::min(end + 2.0 * width, length);
                continue;
            }
            if (bounds.exact && bounds.changes_sign_once()) return refine(ray, chords, start, end);
            const double clear = negative_until(bounds.upper);
            double until = 0.0;
            for (const double part : {1.0 / 32.0, 1.0 / 8.0, 0.5}) {
                const double x = clear + part * (1.0 - clear);
                if (value_at(bounds.lower, x) > 0.0) {
                    until = x;
                    break;
                }
            }
            const double next = clear * (15.0 / 16.0);
            if (until == 0.0) until = next > 0.25 ? 1.0 : 0.5 + 0.5 * next;
            const double from = start + next * width;
            end = std::min(end, start + until * width);
            if (!(end > from)) return hit_at(ray, chords, from);
            start = from;
        }
        return UNDECIDED;
    }
};

// What a query is about, behind Embree's own.
struct Context {
    RTCIntersectContext embree;
    const Scene *scene;
    const Ray *ray;
    // Where balls go, or none where the nearest entry into a support is asked for.
    Chords *chords;
};

void bounds_of(const RTCBoundsFunctionArguments *arguments) {
    const Ball &ball = static_cast<const Scene *>(arguments->geometryUserPtr)->balls[arguments->primID];
    RTCBounds &bounds = *arguments->bounds_o;
    const auto below = [](float x, float radius) { return std::nextafter(x - radius, -INFINITY); };
    const auto above = [](float x, float radius) { return std::nextafter(x + radius, INFINITY); };
    bounds.lower_x = below(ball.x, ball.radius);
    bounds.lower_y = below(ball.y, ball.radius);
    bounds.lower_z = below(ball.z, ball.radius);
    bounds.upper_x = above(ball.x, ball.radius);
    bounds.upper_y = above(ball.y, ball.radius);
    bounds.upper_z = above(ball.z, ball.radius);
}

// Notes the ball, or where the ray enters its support.
void meet(const RTCIntersectFunctionNArguments *arguments) {
    if (!arguments->valid[0]) return;
    const Context &context = *reinterpret_cast<const Context *>(arguments->context);
    RTCRayHit &found = *reinterpret_cast<RTCRayHit *>(arguments->rayhit);
    const Ball &ball = context.scene->balls[arguments->primID];
    if (context.chords) {
        context.chords->add(ball, arguments->primID, *context.ray, found.ray.tfar);
        return;
    }
    const Ray &ray = *context.ray;
    const double x = double(ball.x) - ray.origin[0], y = double(ball.y) - ray.origin[1],
                 z = double(ball.z) - ray.origin[2];
    const double along = x * ray.direction[0] + y * ray.direction[1] + z * ray.direction[2];
    const double off = x * x + y * y + z * z - along * along;
    const double half = double(ball.radius) * ball.radius - off;
    if (half <= 0.0) return;
    const double reach = std::sqrt(half);
    const float enter = std::max(float(along - reach), found.ray.tnear);
    if (along + reach > found.ray.tnear && enter < found.ray.tfar) {
        found.ray.tfar = enter;
        found.hit.geomID = arguments->geomID;
    }
}

struct Tracer {
    const Scene &scene;
    RTCScene embree;
    // Scene units; 0 for whole rays.
    double window;

    float query(const Ray &ray, double start, double end, Chords *chords) const {
        Context context{};
        rtcInitIntersectContext(&context.embree);
        context.scene = &scene;
        context.ray = &ray;
        context.chords = chords;
        RTCRayHit found{};
        found.ray = {ray.origin[0], ray.origin[1], ray.origin[2], float(start), ray.direction[0],
                     ray.direction[1], ray.direction[2], 0.0f, float(end), ~0u, 0, 0};
        found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(embree, &context.embree, &found);
        return found.hit.geomID == RTC_INVALID_GEOMETRY_ID ? INFINITY : found.ray.tfar;
    }

    Hit first_hit(const Ray &ray, Chords &chords) const {
        double start = ray.t_min;
        if (window == 0.0) {
            chords.clear(start);
            query(ray, start, ray.t_max, &chords);
            // No further than the last support.
            double length = 0.0;
            for (size_t ball = 0; ball < chords.balls.size(); ++ball) {
                const double middle = 0.5 * chords.linear[ball] / chords.square[ball];
                const double peak = chords.constant[ball] + 0.5 * chords.linear[ball] * middle;
                length = std::max(length, middle + std::sqrt(std::max(peak, 0.0) / chords.square[ball]));
            }
            return scene.first_root(ray, chords, std::min(length, ray.t_max - start), true);
        }
        while (start < ray.t_max) {
            const float enter = query(ray, start, ray.t_max, nullptr);
            if (enter == INFINITY) return MISS;
            // A float holds both ends, as Embree's ray does.
            const double end = std::min(float(enter + window), ray.t_max);
            chords.clear(enter);
            query(ray, enter, end, &chords);
            const Hit hit = scene.first_root(ray, chords, end - enter, enter <= ray.t_min);
            if (!(hit.t == INFINITY)) return hit;
            if (end <= start) return UNDECIDED;
            start = end;
        }
        return MISS;
    }
};

template <class T> std::vector<T> read(const char *file) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) {
        std::fprintf(stderr, "%s: cannot be read\n", file);
        std::exit(1);
    }
    std::vector<T> items(size_t(stream.tellg()) / sizeof(T));
    stream.seekg(0);
    stream.read(reinterpret_cast<char *>(items.data()), std::streamsize(items.size() * sizeof(T)));
    return items;
}

bool write(const std::vector<Hit> &hits, unsigned width, unsigned height) {
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(height) +
                         ", " + std::to_string(width) + ", 4), }";
    header.resize((header.size() + 11 + 63) / 64 * 64 - 11, ' ');
    header += '\n';
    std::ofstream stream("hits.npy", std::ios::binary);
    stream.write("\x93NUMPY\x01\x00", 8);
    stream.put(char(header.size() & 0xff)).put(char(header.size() >> 8));
    stream << header;
    stream.write(reinterpret_cast<const char *>(hits.data()), std::streamsize(hits.size() * sizeof(Hit)));
    return bool(stream.flush());
}

double wall() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

double processor() {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1e3 * double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-3 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

// Tiles of 16 × 16 rays, so that neighbours follow each other.
void trace(const Tracer &tracer, const std::vector<Ray> &rays, std::vector<Hit> &hits, unsigned width,
           unsigned height, unsigned threads) {
    constexpr unsigned SIDE = 16;
    const unsigned across = (width + SIDE - 1) / SIDE, down = (height + SIDE - 1) / SIDE;
    std::atomic<unsigned> next{0};
    const auto work = [&] {
        Chords chords;
        for (unsigned tile; (tile = next++) < across * down;) {
            const unsigned left = tile % across * SIDE, top = tile / across * SIDE;
            for (unsigned y = top; y < std::min(top + SIDE, height); ++y) {
                for (unsigned x = left; x < std::min(left + SIDE, width); ++x) {
                    const size_t pixel = size_t(y) * width + x;
                    hits[pixel] = tracer.first_hit(rays[pixel], chords);
                }
            }
        }
    };
    std::vector<std::thread> workers;
    for (unsigned thread = 0; thread < threads; ++thread) workers.emplace_back(work);
    for (std::thread &worker : workers) worker.join();
}

} // namespace

int main(int count, char **arguments) {
    if (count == 2 && std::string(arguments[1]) == "--version") {
        std::printf("Embree " RTC_VERSION_STRING "\n");
        return 0;
    }
    if (count != 6) {
        std::fprintf(stderr, "needed THRESHOLD WIDTH HEIGHT THREADS WINDOW\n");
        return 2;
    }
    const auto width = unsigned(std::atoi(arguments[2])), height = unsigned(std::atoi(arguments[3]));
    const std::string threads = arguments[4];
    const Scene scene{read<Ball>("balls.f32"), std::strtof(arguments[1], nullptr)};
    const auto rays = read<Ray>("rays.f32");
    if (rays.size() != size_t(width) * height || scene.balls.empty()) {
        std::fprintf(stderr, "needed balls and %u x %u rays, found %zu and %zu\n", width, height,
                     scene.balls.size(), rays.size());
        return 1;
    }
    std::vector<Hit> hits(rays.size());
    RTCDevice device = rtcNewDevice(("threads=" + threads).c_str());
    if (!device) {
        std::fprintf(stderr, "Embree: no device, error %d\n", int(rtcGetDeviceError(nullptr)));
        return 1;
    }

    const double started = wall();
    double mean = 0.0;
    for (const Ball &ball : scene.balls) mean += ball.radius / double(scene.balls.size());
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(scene.balls.size()));
    rtcSetGeometryUserData(geometry, const_cast<Scene *>(&scene));
    rtcSetGeometryBoundsFunction(geometry, [](const RTCBoundsFunctionArguments *a) { bounds_of(a); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, meet);
    rtcCommitGeometry(geometry);
    RTCScene embree = rtcNewScene(device);
    rtcAttachGeometry(embree, geometry);
    rtcCommitScene(embree);
    const double built = wall(), before = processor();
    const Tracer tracer{scene, embree, mean * std::atof(arguments[5])};
    trace(tracer, rays, hits, width, height, unsigned(std::stoul(threads)));
    const double traced = wall(), after = processor();

    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
        std::fprintf(stderr, "Embree: error %d\n", int(error));
        return 1;
    }
    if (!write(hits, width, height)) {
        std::fprintf(stderr, "hits.npy: cannot be written\n");
        return 1;
    }
    std::printf("prepare %.4f\ntrace %.4f\nprocessor %.4f\n", built - started, traced - built, after - before);
    rtcReleaseScene(embree);
    rtcReleaseGeometry(geometry);
    rtcReleaseDevice(device);
    return 0;
}
