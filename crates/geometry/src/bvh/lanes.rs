//! Eight single-precision numbers at a time, on the vector unit that the machine has.
//!
//! Every unit gives the same bits: there are only operations that IEEE 754 rounds in one way, and no fused ones.

/// Operations on eight numbers.
///
/// What uses them must be a function inlined always: a closure handed to a function of the standard library is compiled
/// for every machine.
pub(super) trait Lanes: Copy {
    /// Eight numbers.
    type Eight: Copy;

    fn load(self, values: &[f32; 8]) -> Self::Eight;
    fn store(self, eight: Self::Eight) -> [f32; 8];
    fn splat(self, value: f32) -> Self::Eight;
    fn add(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn sub(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn mul(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// The lesser; `b` where one is no number.
    fn min(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// The greater; `b` where one is no number.
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// One bit a lane: whether a ≤ b; false where one is no number.
    fn at_most(self, a: Self::Eight, b: Self::Eight) -> u32;

    #[inline(always)]
    fn negative(self, a: Self::Eight) -> Self::Eight {
        self.sub(self.splat(0.0), a)
    }

    #[inline(always)]
    fn abs(self, a: Self::Eight) -> Self::Eight {
        self.max(a, self.negative(a))
    }

    #[inline(always)]
    fn min3(self, [a, b, c]: [Self::Eight; 3]) -> Self::Eight {
        self.min(self.min(a, b), c)
    }

    #[inline(always)]
    fn max3(self, [a, b, c]: [Self::Eight; 3]) -> Self::Eight {
        self.max(self.max(a, b), c)
    }

    #[inline(always)]
    fn splat3(self, [a, b, c]: [f32; 3]) -> [Self::Eight; 3] {
        [self.splat(a), self.splat(b), self.splat(c)]
    }

    /// Differences between three loaded and three given.
    #[inline(always)]
    fn load_less(self, a: [&[f32; 8]; 3], b: [Self::Eight; 3]) -> [Self::Eight; 3] {
        [
            self.sub(self.load(a[0]), b[0]),
            self.sub(self.load(a[1]), b[1]),
            self.sub(self.load(a[2]), b[2]),
        ]
    }

    #[inline(always)]
    fn sub3(self, a: [Self::Eight; 3], b: [Self::Eight; 3]) -> [Self::Eight; 3] {
        [
            self.sub(a[0], b[0]),
            self.sub(a[1], b[1]),
            self.sub(a[2], b[2]),
        ]
    }

    /// a₀ b₁ − a₁ b₀.
    #[inline(always)]
    fn minor(self, [a0, a1]: [Self::Eight; 2], [b0, b1]: [Self::Eight; 2]) -> Self::Eight {
        self.sub(self.mul(a0, b1), self.mul(a1, b0))
    }

    #[inline(always)]
    fn cross(
        self,
        [ax, ay, az]: [Self::Eight; 3],
        [bx, by, bz]: [Self::Eight; 3],
    ) -> [Self::Eight; 3] {
        [
            self.minor([ay, az], [by, bz]),
            self.minor([az, ax], [bz, bx]),
            self.minor([ax, ay], [bx, by]),
        ]
    }
}

/// Work to be done with whatever lanes there are; its parts must be inlined into it.
pub(super) trait Work {
    type Output;
    fn with<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// The vector unit of this machine.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unit {
    #[cfg(target_arch = "x86_64")]
    avx2: Option<pulp::x86::V3>,
}

impl Unit {
    /// The best there is.
    pub fn detect() -> Self {
        Self {
            #[cfg(target_arch = "x86_64")]
            avx2: pulp::x86::V3::try_new(),
        }
    }

    /// The one that every machine has.
    #[cfg(test)]
    pub fn portable() -> Self {
        Self {
            #[cfg(target_arch = "x86_64")]
            avx2: None,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        #[cfg(target_arch = "x86_64")]
        if self.avx2.is_some() {
            return "AVX2";
        }
        "portable"
    }

    #[inline(always)]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = self.avx2 {
            return avx2.vectorize(InAvx2 { avx2, work });
        }
        work.with(Portable)
    }
}

/// Compiled for AVX2 as a whole.
#[cfg(target_arch = "x86_64")]
struct InAvx2<W> {
    avx2: pulp::x86::V3,
    work: W,
}

#[cfg(target_arch = "x86_64")]
impl<W: Work> pulp::NullaryFnOnce for InAvx2<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.work.with(self.avx2)
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes for pulp::x86::V3 {
    type Eight = std::arch::x86_64::__m256;

    #[inline(always)]
    fn load(self, values: &[f32; 8]) -> Self::Eight {
        pulp::cast(*values)
    }
    #[inline(always)]
    fn store(self, eight: Self::Eight) -> [f32; 8] {
        pulp::cast(eight)
    }
    #[inline(always)]
    fn splat(self, value: f32) -> Self::Eight {
        self.avx._mm256_set1_ps(value)
    }
    #[inline(always)]
    fn add(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.avx._mm256_add_ps(a, b)
    }
    #[inline(always)]
    fn sub(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.avx._mm256_sub_ps(a, b)
    }
    #[inline(always)]
    fn mul(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.avx._mm256_mul_ps(a, b)
    }
    #[inline(always)]
    fn min(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.avx._mm256_min_ps(a, b)
    }
    #[inline(always)]
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.avx._mm256_max_ps(a, b)
    }
    #[inline(always)]
    fn at_most(self, a: Self::Eight, b: Self::Eight) -> u32 {
        use std::arch::x86_64::_CMP_LE_OQ;
        let mask = self.avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b);
        self.avx._mm256_movemask_ps(mask).cast_unsigned()
    }
}

/// What every machine can do.
#[derive(Debug, Clone, Copy)]
struct Portable;

impl Lanes for Portable {
    type Eight = [f32; 8];

    #[inline(always)]
    fn load(self, values: &[f32; 8]) -> [f32; 8] {
        *values
    }
    #[inline(always)]
    fn store(self, eight: [f32; 8]) -> [f32; 8] {
        eight
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
}
