//! Eight or sixteen single-precision numbers at a time, on the vector unit that the machine has.
//!
//! Every unit gives the same bits: there are only operations that IEEE 754 rounds in one way, and no fused ones.

#[cfg(target_arch = "x86_64")]
use pulp::{
    NullaryFnOnce,
    x86::{V3, V4},
};
#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::{__m256, __m512, _CMP_LE_OQ};

/// Operations on `N` numbers.
///
/// What uses them must be a function inlined always: a closure handed to a function of the standard library is compiled
/// for every machine.
pub(crate) trait Lanes<const N: usize>: Copy {
    /// So many numbers.
    type Numbers: Copy;

    fn load(self, values: &[f32; N]) -> Self::Numbers;
    fn store(self, numbers: Self::Numbers) -> [f32; N];
    fn splat(self, value: f32) -> Self::Numbers;
    fn add(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn sub(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn mul(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// The lesser; `b` where one is no number.
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// The greater; `b` where one is no number.
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// One bit a lane: whether a ≤ b; false where one is no number.
    fn at_most(self, a: Self::Numbers, b: Self::Numbers) -> u32;
    /// The least of all lanes, none of which is no number.
    fn least(self, a: Self::Numbers) -> f32;

    /// The greatest of all lanes.
    #[inline(always)]
    fn most(self, a: Self::Numbers) -> f32 {
        // A zero must not become a negative one.
        0.0 - self.least(self.negative(a))
    }

    #[inline(always)]
    fn negative(self, a: Self::Numbers) -> Self::Numbers {
        self.sub(self.splat(0.0), a)
    }

    #[inline(always)]
    fn abs(self, a: Self::Numbers) -> Self::Numbers {
        self.max(a, self.negative(a))
    }

    #[inline(always)]
    fn min3(self, [a, b, c]: [Self::Numbers; 3]) -> Self::Numbers {
        self.min(self.min(a, b), c)
    }

    #[inline(always)]
    fn max3(self, [a, b, c]: [Self::Numbers; 3]) -> Self::Numbers {
        self.max(self.max(a, b), c)
    }

    #[inline(always)]
    fn splat3(self, [a, b, c]: [f32; 3]) -> [Self::Numbers; 3] {
        [self.splat(a), self.splat(b), self.splat(c)]
    }

    #[inline(always)]
    fn load3(self, [a, b, c]: &[[f32; N]; 3]) -> [Self::Numbers; 3] {
        [self.load(a), self.load(b), self.load(c)]
    }

    /// Differences between three loaded and three given.
    #[inline(always)]
    fn load_less(self, a: [&[f32; N]; 3], b: [Self::Numbers; 3]) -> [Self::Numbers; 3] {
        [
            self.sub(self.load(a[0]), b[0]),
            self.sub(self.load(a[1]), b[1]),
            self.sub(self.load(a[2]), b[2]),
        ]
    }

    #[inline(always)]
    fn sub3(self, a: [Self::Numbers; 3], b: [Self::Numbers; 3]) -> [Self::Numbers; 3] {
        [
            self.sub(a[0], b[0]),
            self.sub(a[1], b[1]),
            self.sub(a[2], b[2]),
        ]
    }

    /// a₀ b₁ − a₁ b₀.
    #[inline(always)]
    fn minor(self, [a0, a1]: [Self::Numbers; 2], [b0, b1]: [Self::Numbers; 2]) -> Self::Numbers {
        self.sub(self.mul(a0, b1), self.mul(a1, b0))
    }

    #[inline(always)]
    fn cross(
        self,
        [ax, ay, az]: [Self::Numbers; 3],
        [bx, by, bz]: [Self::Numbers; 3],
    ) -> [Self::Numbers; 3] {
        [
            self.minor([ay, az], [by, bz]),
            self.minor([az, ax], [bz, bx]),
            self.minor([ax, ay], [bx, by]),
        ]
    }
}

/// Work to be done with whatever lanes there are; its parts must be inlined into it.
pub(crate) trait Work {
    type Output;
    fn with<E: Lanes<8>, T: Lanes<16>>(self, eight: E, sixteen: T) -> Self::Output;
}

/// The vector unit of this machine.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Unit {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(V3),
    #[cfg(target_arch = "x86_64")]
    Avx512(V4),
}

impl Unit {
    /// Those that this machine has, the best first.
    pub fn all() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let special = [
            V4::try_new().map(Self::Avx512),
            V3::try_new().map(Self::Avx2),
        ];
        #[cfg(not(target_arch = "x86_64"))]
        let special: [Option<Self>; 0] = [];
        special.into_iter().flatten().chain([Self::Portable])
    }

    /// The best there is.
    pub fn detect() -> Self {
        Self::all().next().unwrap_or(Self::Portable)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => "AVX-512",
        }
    }

    #[inline(always)]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        match self {
            Self::Portable => work.with(Portable, Halves(Portable)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(unit) => unit.vectorize(InAvx2 { unit, work }),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(unit) => unit.vectorize(InAvx512 { unit, work }),
        }
    }
}

/// Compiled for AVX2 as a whole.
#[cfg(target_arch = "x86_64")]
struct InAvx2<W> {
    unit: V3,
    work: W,
}

#[cfg(target_arch = "x86_64")]
impl<W: Work> NullaryFnOnce for InAvx2<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.work.with(self.unit, Halves(self.unit))
    }
}

/// Compiled for AVX-512 as a whole.
#[cfg(target_arch = "x86_64")]
struct InAvx512<W> {
    unit: V4,
    work: W,
}

#[cfg(target_arch = "x86_64")]
impl<W: Work> NullaryFnOnce for InAvx512<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.work.with(*self.unit, self.unit)
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes<16> for V4 {
    type Numbers = __m512;

    #[inline(always)]
    fn load(self, values: &[f32; 16]) -> __m512 {
        pulp::cast(*values)
    }
    #[inline(always)]
    fn store(self, numbers: __m512) -> [f32; 16] {
        pulp::cast(numbers)
    }
    #[inline(always)]
    fn splat(self, value: f32) -> __m512 {
        self.avx512f._mm512_set1_ps(value)
    }
    #[inline(always)]
    fn add(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_add_ps(a, b)
    }
    #[inline(always)]
    fn sub(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_sub_ps(a, b)
    }
    #[inline(always)]
    fn mul(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_mul_ps(a, b)
    }
    #[inline(always)]
    fn min(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_min_ps(a, b)
    }
    #[inline(always)]
    fn max(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_max_ps(a, b)
    }
    #[inline(always)]
    fn at_most(self, a: __m512, b: __m512) -> u32 {
        u32::from(self.avx512f._mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b))
    }
    #[inline(always)]
    fn least(self, a: __m512) -> f32 {
        self.avx512f._mm512_reduce_min_ps(a)
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes<8> for V3 {
    type Numbers = __m256;

    #[inline(always)]
    fn load(self, values: &[f32; 8]) -> __m256 {
        pulp::cast(*values)
    }
    #[inline(always)]
    fn store(self, numbers: __m256) -> [f32; 8] {
        pulp::cast(numbers)
    }
    #[inline(always)]
    fn splat(self, value: f32) -> __m256 {
        self.avx._mm256_set1_ps(value)
    }
    #[inline(always)]
    fn add(self, a: __m256, b: __m256) -> __m256 {
        self.avx._mm256_add_ps(a, b)
    }
    #[inline(always)]
    fn sub(self, a: __m256, b: __m256) -> __m256 {
        self.avx._mm256_sub_ps(a, b)
    }
    #[inline(always)]
    fn mul(self, a: __m256, b: __m256) -> __m256 {
        self.avx._mm256_mul_ps(a, b)
    }
    #[inline(always)]
    fn min(self, a: __m256, b: __m256) -> __m256 {
        self.avx._mm256_min_ps(a, b)
    }
    #[inline(always)]
    fn max(self, a: __m256, b: __m256) -> __m256 {
        self.avx._mm256_max_ps(a, b)
    }
    #[inline(always)]
    fn at_most(self, a: __m256, b: __m256) -> u32 {
        let mask = self.avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b);
        self.avx._mm256_movemask_ps(mask).cast_unsigned()
    }
    #[inline(always)]
    fn least(self, a: __m256) -> f32 {
        let low = self.avx._mm256_castps256_ps128(a);
        let four = self
            .sse
            ._mm_min_ps(low, self.avx._mm256_extractf128_ps::<1>(a));
        let two = self
            .sse
            ._mm_min_ps(four, self.sse._mm_movehl_ps(four, four));
        let one = self.sse._mm_min_ss(two, self.sse3._mm_movehdup_ps(two));
        self.sse._mm_cvtss_f32(one)
    }
}

/// Sixteen numbers as twice eight.
#[derive(Debug, Clone, Copy)]
struct Halves<L>(L);

impl<L: Lanes<8>> Lanes<16> for Halves<L> {
    type Numbers = [L::Numbers; 2];

    #[inline(always)]
    fn load(self, values: &[f32; 16]) -> Self::Numbers {
        let [a, b]: [[f32; 8]; 2] = pulp::cast(*values);
        [self.0.load(&a), self.0.load(&b)]
    }
    #[inline(always)]
    fn store(self, [a, b]: Self::Numbers) -> [f32; 16] {
        pulp::cast([self.0.store(a), self.0.store(b)])
    }
    #[inline(always)]
    fn splat(self, value: f32) -> Self::Numbers {
        [self.0.splat(value); 2]
    }
    #[inline(always)]
    fn add(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        [self.0.add(a[0], b[0]), self.0.add(a[1], b[1])]
    }
    #[inline(always)]
    fn sub(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        [self.0.sub(a[0], b[0]), self.0.sub(a[1], b[1])]
    }
    #[inline(always)]
    fn mul(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        [self.0.mul(a[0], b[0]), self.0.mul(a[1], b[1])]
    }
    #[inline(always)]
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        [self.0.min(a[0], b[0]), self.0.min(a[1], b[1])]
    }
    #[inline(always)]
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        [self.0.max(a[0], b[0]), self.0.max(a[1], b[1])]
    }
    #[inline(always)]
    fn at_most(self, a: Self::Numbers, b: Self::Numbers) -> u32 {
        self.0.at_most(a[0], b[0]) | self.0.at_most(a[1], b[1]) << 8
    }
    #[inline(always)]
    fn least(self, [a, b]: Self::Numbers) -> f32 {
        self.0.least(self.0.min(a, b))
    }
}

/// What every machine can do.
#[derive(Debug, Clone, Copy)]
struct Portable;

impl Lanes<8> for Portable {
    type Numbers = [f32; 8];

    #[inline(always)]
    fn load(self, values: &[f32; 8]) -> [f32; 8] {
        *values
    }
    #[inline(always)]
    fn store(self, numbers: [f32; 8]) -> [f32; 8] {
        numbers
    }
    #[inline(always)]
    fn splat(self, value: f32) -> [f32; 8] {
        [value; 8]
    }
    #[inline(always)]
    fn add(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|lane| a[lane] + b[lane])
    }
    #[inline(always)]
    fn sub(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|lane| a[lane] - b[lane])
    }
    #[inline(always)]
    fn mul(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|lane| a[lane] * b[lane])
    }
    #[inline(always)]
    fn min(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|lane| if a[lane] < b[lane] { a[lane] } else { b[lane] })
    }
    #[inline(always)]
    fn max(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|lane| if a[lane] > b[lane] { a[lane] } else { b[lane] })
    }
    #[inline(always)]
    fn at_most(self, a: [f32; 8], b: [f32; 8]) -> u32 {
        (0..8).fold(0, |bits, lane| bits | u32::from(a[lane] <= b[lane]) << lane)
    }
    #[inline(always)]
    fn least(self, [a, b, c, d, e, f, g, h]: [f32; 8]) -> f32 {
        let least = |a: f32, b: f32| if a < b { a } else { b };
        least(
            least(least(a, e), least(c, g)),
            least(least(b, f), least(d, h)),
        )
    }
}
