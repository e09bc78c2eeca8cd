//! Constrained systems of tests and benchmarks.

use pendulum_runtime::prelude::*;

lagrangian! {
    /// A bob on a rod, in Cartesian coordinates.
    #[derive(Clone, Debug)]
    pub struct Bob { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = m/2*(ẋ^2 + ẏ^2);
    potential = m*g*y;
    constraint rod: x^2 + y^2 = L^2;
    output pull: N = 2*L*reaction(rod);
}

lagrangian! {
    /// The same in minimal coordinates.
    #[derive(Clone, Debug)]
    pub struct Simple { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    kinetic = L^2/2*θ̇^2;
    potential = -g*L*cos(θ);
}

lagrangian! {
    /// A four-bar linkage.
    #[derive(Clone, Debug)]
    pub struct FourBar { l: [m; 3], d: m, m: [kg; 3], g: m/s^2 = 9.81 }
    coordinate α: rad;
    coordinate β: rad;
    coordinate γ: rad;
    let a = l[0]*cis(α);
    let b = a + l[1]*cis(β);
    kinetic = m[0]/6*l[0]^2*α̇^2 + m[1]/2*|dot(a + l[1]/2*cis(β))|^2 + m[1]/24*l[1]^2*β̇^2
        + m[2]/6*l[2]^2*γ̇^2;
    potential = g*(m[0]*height(a)/2 + m[1]*height(a + b)/2 + m[2]*l[2]*sin(γ)/2);
    constraint loop: b = [d, 0] + l[2]*cis(γ);
    output pull: [N; 2] = reaction(loop);
    output coupler: [m; 2] = (a + b)/2;
}

lagrangian! {
    /// Andrews' squeezing mechanism (Hairer and Wanner, Solving ODEs II, section VII.7).
    #[derive(Clone, Debug)]
    pub struct Andrews {
        m: [kg; 7], J: [kg*m^2; 7],
        A: [m; 2], B: [m; 2], C: [m; 2],
        d: m, da: m, e: m, ea: m, zf: m, fa: m, rr: m, ra: m, ss: m, sa: m, sb: m, sc: m, sd: m,
        zt: m, ta: m, tb: m, u: m, ua: m, ub: m, c0: N/m, l0: m, mom: N*m,
    }
    coordinate β: rad;
    coordinate Θ: rad;
    coordinate γ: rad;
    coordinate Φ: rad;
    coordinate δ: rad;
    coordinate Ω: rad;
    coordinate ε: rad;
    let p = rr*cis(β) - d*cis(β + Θ);
    kinetic = (m[0]*ra^2 + J[0])/2*β̇^2
        + m[1]/2*|dot(rr*cis(β) - da*cis(β + Θ))|^2 + J[1]/2*(β̇ + Θ̇)^2
        + (m[2]*(sa^2 + sb^2) + J[2])/2*γ̇^2
        + m[3]/2*|dot(zt*cis(δ) - i*(e - ea)*cis(Φ + δ))|^2 + J[3]/2*(Φ̇ + δ̇)^2
        + (m[4]*(ta^2 + tb^2) + J[4])/2*δ̇^2
        + m[5]/2*|dot((zf - fa)*cis(Ω + ε) - i*u*cis(ε))|^2 + J[5]/2*(Ω̇ + ε̇)^2
        + (m[6]*(ua^2 + ub^2) + J[6])/2*ε̇^2;
    potential = c0/2*(|B + (sd - i*sc)*cis(γ) - C| - l0)^2;
    force β = mom;
    constraint first: p + i*ss*cis(γ) = B;
    constraint second: p + i*e*cis(Φ + δ) - zt*cis(δ) = A;
    constraint third: p - zf*cis(Ω + ε) + i*u*cis(ε) = A;
}

lagrangian! {
    /// The car axis of the test set for initial value problems.
    #[derive(Clone, Debug)]
    pub struct CarAxis { k: kg, L: m, L0: m, r: m, ω: Hz, g: m/s^2, s: N/m }
    coordinate xl: m;
    coordinate yl: m;
    coordinate xr: m;
    coordinate yr: m;
    let h = r*sin(ω*t);
    let b = [sqrt(L^2 - h^2), h];
    let l = [xl, yl];
    let right = [xr, yr];
    kinetic = k/2*(|dot(l)|^2 + |dot(right)|^2);
    potential = s/2*(|l| - L0)^2 + s/2*(|right - b| - L0)^2 + k*g*(yl + yr);
    constraint axis: inner(b, l) = 0;
    constraint rod: |l - right|^2 = L^2;
}

lagrangian! {
    /// Chaplygin's sleigh: a blade at (x, y) along θ, the mass centre `a` ahead of it.
    #[derive(Clone, Debug)]
    pub struct Sleigh { m: kg, I: kg*m^2, a: m }
    coordinate x: m;
    coordinate y: m;
    coordinate θ: rad;
    let center = [x, y] + a*cis(θ);
    kinetic = m/2*|dot(center)|^2 + I/2*θ̇^2;
    constraint blade: ẏ*cos(θ) = ẋ*sin(θ);
    output side: N = reaction(blade);
}

lagrangian! {
    /// A disc that rolls: heading ψ, lean θ from upright to the right, spin φ.
    #[derive(Clone, Debug)]
    pub struct Disc { m: kg, r: m, A: kg*m^2, C: kg*m^2, g: m/s^2 = 9.81 }
    coordinate X: m;
    coordinate Y: m;
    coordinate ψ: rad;
    coordinate θ: rad;
    coordinate φ: rad;
    let center = [X + r*sin(θ)*sin(ψ), Y - r*sin(θ)*cos(ψ), r*cos(θ)];
    kinetic = m/2*|dot(center)|^2 + A/2*(θ̇^2 + ψ̇^2*cos(θ)^2) + C/2*(φ̇ + ψ̇*sin(θ))^2;
    potential = m*g*height(center);
    constraint along: Ẋ = r*φ̇*cos(ψ);
    constraint across: Ẏ = r*φ̇*sin(ψ);
}

lagrangian! {
    /// A ball that rolls on a turntable, by the velocities of its rolling alone.
    #[derive(Clone, Debug)]
    pub struct Ball { m: kg, r: m, J: kg*m^2, Ω: Hz }
    coordinate x: m;
    coordinate y: m;
    coordinate α: rad;
    coordinate β: rad;
    kinetic = m/2*(ẋ^2 + ẏ^2) + J/2*(α̇^2 + β̇^2);
    constraint along: ẋ - r*β̇ = -Ω*y;
    constraint across: ẏ + r*α̇ = Ω*x;
}

/// A linkage of N loops: N + 1 uprights on the ground, uniform unit rods.
macro_rules! loops {
    ($name:ident, $n:literal, $uprights:literal) => {
        lagrangian! {
            #[derive(Clone, Debug)]
            pub struct $name { m: kg, L: m, g: m/s^2 = 9.81 }
            coordinate φ[$uprights]: rad;
            coordinate ψ[$n]: rad;
            let a[k in 0..$uprights] = L*[k, 0] + L*cis(φ[k]);
            kinetic = sum(k in 0..$uprights, m*L^2/6*φ̇[k]^2)
                + sum(k in 0..$n, m/2*|dot(a[k] + L/2*cis(ψ[k]))|^2 + m*L^2/24*ψ̇[k]^2);
            potential = sum(k in 0..$uprights, m*g*L/2*sin(φ[k]))
                + sum(k in 0..$n, m*g*height(a[k] + L/2*cis(ψ[k])));
            constraint loop[k in 0..$n]: a[k] + L*cis(ψ[k]) = a[k + 1];
        }
    };
}

lagrangian! {
    /// A chain with both ends held.
    #[derive(Clone, Debug)]
    pub struct Garland { m: kg, L: m, d: m, g: m/s^2 = 9.81 }
    coordinate θ[16]: rad;
    let y[k in 0..16] = sum(j in 0..=k, L*cis(θ[j]));
    kinetic = sum(k in 0..16, m/2*|ẏ[k]|^2);
    potential = sum(k in 0..16, m*g*height(y[k]));
    constraint end: y[15] = [d, d*t*t*g/d];
}

lagrangian! {
    /// Two arms of seven links on one root, whose ends a rod ties together, and whose middle moves.
    #[derive(Clone, Debug)]
    pub struct Arms { m: kg, L: m, d: m, k: N/m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate α[7]: rad;
    coordinate β[7]: rad;
    let root = [x, 0];
    let a[k in 0..7] = root + sum(j in 0..=k, L*cis(α[j]));
    let b[k in 0..7] = root + sum(j in 0..=k, L*cis(β[j]));
    kinetic = m/2*ẋ^2 + sum(k in 0..7, m/2*(|ȧ[k]|^2 + |ḃ[k]|^2));
    potential = k/2*x^2 + sum(k in 0..7, m*g*(height(a[k]) + height(b[k])));
    constraint rod: |a[6] - b[6]|^2 = d^2;
    constraint guide: height(a[3]) + height(b[3])^2/L = x;
}

loops!(Loops2, 2, 3);
loops!(Loops10, 10, 11);

/// Returns Andrews' mechanism with the constants of the test set.
pub fn andrews() -> Andrews {
    Andrews {
        m: [0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498],
        J: [2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5],
        A: [-0.06934, -0.00227],
        B: [-0.03635, 0.03273],
        C: [0.014, 0.072],
        d: 0.028,
        da: 0.0115,
        e: 0.02,
        ea: 0.01421,
        zf: 0.02,
        fa: 0.01421,
        rr: 0.007,
        ra: 0.00092,
        ss: 0.035,
        sa: 0.01874,
        sb: 0.01043,
        sc: 0.018,
        sd: 0.02,
        zt: 0.04,
        ta: 0.02308,
        tb: 0.00916,
        u: 0.04,
        ua: 0.01228,
        ub: 0.00449,
        c0: 4530.0,
        l0: 0.07785,
        mom: 0.033,
    }
}

/// The start of Andrews' mechanism, at rest.
pub const ANDREWS_START: [f64; 7] = [
    -0.0617138900142764496358948458001,
    0.0,
    0.455279819163070380255912382449,
    0.222668390165885884674473185609,
    0.487364979543842550225598953530,
    -0.222668390165885884674473185609,
    1.23054744454982119249735015568,
];

/// Andrews' mechanism at t = 0.03, recomputed to 28 digits. The published values are wrong from the
/// tenth digit on.
pub const ANDREWS_END: [[f64; 7]; 2] = [
    [
        15.810771195153707097119387,
        -15.756371058411839469727753,
        0.040822240119645804854828,
        -0.53473011634207957937702,
        0.52440996587995406937167,
        0.53473011634207957937702,
        1.0480807410419378730685,
    ],
    [
        1139.9203022591060641980968,
        -1424.3792951775400731960264,
        11.032911910618593745327,
        19.293374105032040831628,
        0.57356991482950245381769,
        -19.293374105032040831628,
        0.32317914924913087499075,
    ],
];

/// Returns the car axis with the constants of the test set.
pub fn car_axis() -> CarAxis {
    CarAxis { k: 5e-4, L: 1.0, L0: 0.5, r: 0.1, ω: 10.0, g: 1.0, s: 1.0 }
}

/// The start of the car axis.
pub const CAR_AXIS_START: [[f64; 4]; 2] = [[0.0, 0.5, 1.0, 0.5], [-0.5, 0.0, -0.5, 0.0]];

/// Returns four bars with rational lengths.
pub fn four_bar() -> FourBar {
    FourBar { l: [0.4, 1.1, 0.8], d: 1.0, m: [0.5, 1.2, 0.7], g: 9.81 }
}
