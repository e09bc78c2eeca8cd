//! Andrews' squeezing mechanism.

use pendulum_runtime::prelude::*;

lagrangian! {
    /// Hairer and Wanner, Solving Ordinary Differential Equations II (1996), section VII.7.
    pub struct Andrews {
        m: [kg; 7], J: [kg*m^2; 7], A: [m; 2], B: [m; 2], C: [m; 2],
        d: m = 0.028, da: m = 0.0115, e: m = 0.02, ea: m = 0.01421, zf: m = 0.02, fa: m = 0.01421,
        rr: m = 0.007, ra: m = 0.00092, ss: m = 0.035, sa: m = 0.01874, sb: m = 0.01043,
        sc: m = 0.018, sd: m = 0.02, zt: m = 0.04, ta: m = 0.02308, tb: m = 0.00916,
        u: m = 0.04, ua: m = 0.01228, ub: m = 0.00449, k: N/m = 4530, l: m = 0.07785,
        motor: N*m = 0.033,
    }
    coordinate β: rad;
    coordinate Θ: rad;
    coordinate γ: rad;
    coordinate Φ: rad;
    coordinate δ: rad;
    coordinate Ω: rad;
    coordinate ε: rad;
    let crank = rr*cis(β);
    let p = crank - d*cis(β + Θ);
    kinetic = (m[0]*ra^2 + J[0])/2*β̇^2 + m[1]/2*|dot(crank - da*cis(β + Θ))|^2
        + J[1]/2*(β̇ + Θ̇)^2 + (m[2]*(sa^2 + sb^2) + J[2])/2*γ̇^2
        + m[3]/2*|dot(zt*cis(δ) - i*(e - ea)*cis(Φ + δ))|^2 + J[3]/2*(Φ̇ + δ̇)^2
        + (m[4]*(ta^2 + tb^2) + J[4])/2*δ̇^2
        + m[5]/2*|dot((zf - fa)*cis(Ω + ε) - i*u*cis(ε))|^2 + J[5]/2*(Ω̇ + ε̇)^2
        + (m[6]*(ua^2 + ub^2) + J[6])/2*ε̇^2;
    let spring = B + (sd - i*sc)*cis(γ);
    potential = k/2*(|spring - C| - l)^2;
    force β = motor;
    constraint first: p + i*ss*cis(γ) = B;
    constraint second: p + i*e*cis(Φ + δ) - zt*cis(δ) = A;
    constraint third: p - zf*cis(Ω + ε) + i*u*cis(ε) = A;
    output crank_pin: [m; 2] = crank;
    output joint: [m; 2] = p;
    output left: [m; 2] = A + zt*cis(δ);
    output right: [m; 2] = A - i*u*cis(ε);
    output hook: [m; 2] = spring;
    output pull: N = |reaction(first)|;
}
