//! Components of vectors in space and along the axes of bodies.

use crate::algebra::expr::Graph;
use crate::mechanics::lower;
use crate::messages::Errors;
use crate::model::{self, frame};
use crate::syntax::parse;
use random_systems::Random;

/// Returns the messages about a block without other mistakes, whose equations are not derived.
fn messages(source: &str) -> Vec<String> {
    let mut errors = Errors::default();
    let tokens = format!("::p; {source}").parse().unwrap();
    let (_, block) = parse::all(tokens, &mut errors).unwrap();
    let model = model::resolve(&block, &mut errors);
    lower::energies(&model, &mut Graph::new(), &mut errors);
    assert!(errors.is_empty(), "{source}: {:?}", errors.messages());
    frame::check(&model, &mut errors);
    errors.messages()
}

/// A body in space with its rates and its place along its own axes.
const BODY: &str = "struct S { B: solid, m: kg, k: N/m, f: Hz, g: m/s^2, n: [1; 3] }
    coordinate x: [m; 3]; coordinate R: rotation;
    let W = transpose(R)*angular_velocity(R); let d = transpose(R)*x;
    kinetic = m/2*|dot(x)|^2 + inner(W, B.inertia*W)/2;
    potential = m*g*height(x) + B.mass*g*height(R*B.center);";

/// Statements beside the body, and the message about them.
#[rustfmt::skip]
const OF_A_BODY: &[(&str, &str)] = &[
    ("output o: [m; 3] = x + d;", "`d` has components along the axes of `R`, but `x` has components in space; write `R*d`, or `transpose(R)*x` in place of `x`"),
    ("output o: [m; 3] = x + transpose(R)*x;", "`transpose(R)*x` has components along the axes of `R`, but `x` has components in space; write `x`, or `transpose(R)*x` in place of `x`"),
    ("output o: [rad/s; 3] = W + angular_velocity(R);", "`angular_velocity(R)` has components in space, but `W` has components along the axes of `R`; write `transpose(R)*angular_velocity(R)`, or `R*W` in place of `W`"),
    ("output o: 1/s^2 = inner(angular_velocity(R), W);", "`W` has components along the axes of `R`, but `angular_velocity(R)` has components in space; write `R*W`, or `transpose(R)*angular_velocity(R)` in place of `angular_velocity(R)`"),
    ("output o: [m/s; 3] = cross(angular_velocity(R), d);", "`d` has components along the axes of `R`, but `angular_velocity(R)` has components in space; write `R*d`, or `transpose(R)*angular_velocity(R)` in place of `angular_velocity(R)`"),
    ("output o: [rad/s; 3] = R*angular_velocity(R);", "`angular_velocity(R)` has components in space, but `R` turns vectors with components along the axes of `R`; write `angular_velocity(R)`"),
    ("output o: [rad/s; 3] = transpose(R)*W;", "`W` has components along the axes of `R`, but `transpose(R)` turns vectors with components in space; write `W`"),
    ("output o: [1; 3] = R*R*n;", "`R` leads to components in space, but `R` turns vectors with components along the axes of `R`; write `R`"),
    ("output o: [J*s; 3] = B.inertia*angular_velocity(R);", "`angular_velocity(R)` has components in space here, but `B` has components along the axes of `R` elsewhere; write `transpose(R)*angular_velocity(R)`"),
    ("torque R = f*(B.inertia*W);", "`f*(B.inertia*W)` has components along the axes of `R`, but a torque on `R` has components in space; write `R*f*(B.inertia*W)`"),
    ("force x = k*d;", "`k*d` has components along the axes of `R`, but a force on `x` has components in space; write `R*k*d`"),
    ("force x + R*B.center = k*d;", "`k*d` has components along the axes of `R`, but a force on `x + R*B.center` has components in space; write `R*k*d`"),
    ("output o: m = height(d);", "`d` has components along the axes of `R`, but a height is a component in space; write `height(R*d)`, or `inner([0, 0, 1], d)`"),
    ("output o: m = height(B.center);", "`B.center` has components in space here, but `B` has components along the axes of `R` elsewhere; write `R*B.center`"),
    ("output o: [m; 3] = x + B.center;", "`B.center` has components in space here, but `B` has components along the axes of `R` elsewhere; write `R*B.center`"),
    ("output o: kg*m = integral(p in B, height(p));", "`p` has components in space here, but `B` has components along the axes of `R` elsewhere; write `R*p`"),
    ("constraint c: x = d;", "`d` has components along the axes of `R`, but `x` has components in space; write `R*d`, or `transpose(R)*x` in place of `x`"),
    ("dissipation = k/f*|dot(x) - dot(d)|^2;", "`dot(d)` has components along the axes of `R`, but `dot(x)` has components in space; write `R*dot(d)`, or `transpose(R)*dot(x)` in place of `dot(x)`"),
    ("let s(u) = u + W; output o: [rad/s; 3] = s(angular_velocity(R));", "`W` has components along the axes of `R`, but `u` has components in space; write `R*W`, or `transpose(R)*u` in place of `u`"),
    ("output o: [m/s; 3] = dot(x) + cross(W, R*n)*m*g/k;", "`R*n` has components in space, but `W` has components along the axes of `R`; write `n`, or `R*W` in place of `W`"),
    ("output o: [J; 3] = B.inertia*dot(W) + cross(angular_velocity(R), B.inertia*W);", "`B.inertia*W` has components along the axes of `R`, but `angular_velocity(R)` has components in space; write `R*B.inertia*W`, or `transpose(R)*angular_velocity(R)` in place of `angular_velocity(R)`"),
    ("limit l: |x - d| >= m*g/k, restitution = 0;", "`d` has components along the axes of `R`, but `x` has components in space; write `R*d`, or `transpose(R)*x` in place of `x`"),
];

/// Two bodies in space, and one whose attitude is relative to the first.
const BODIES: &str = "struct S { a: [m; 3], m: kg, k: N/m, g: m/s^2, n: [1; 3] }
    coordinate x: [m; 3]; coordinate A: rotation; coordinate Q: rotation; coordinate S: rotation;
    coordinate α: rad; coordinate β: rad;
    let y = x + A*(a + Q*a); let z = x + S*a; let G = rotation([0, 0, 1], α)*rotation([1, 0, 0], β);
    kinetic = m/2*(|dot(x)|^2 + |dot(y)|^2 + |dot(z)|^2 + |dot(G*a)|^2);
    potential = m*g*(height(y) + height(z) + height(G*a));";

#[rustfmt::skip]
const OF_BODIES: &[(&str, &str)] = &[
    ("output o: [rad/s; 3] = angular_velocity(A) + angular_velocity(Q);", "`angular_velocity(Q)` has components along the axes of `A`, but `angular_velocity(A)` has components in space; write `A*angular_velocity(Q)`, or `transpose(A)*angular_velocity(A)` in place of `angular_velocity(A)`"),
    ("output o: [m; 3] = A*a + transpose(S)*x;", "`transpose(S)*x` has components along the axes of `S`, but `A*a` has components in space; write `x`, or `transpose(S)*A*a` in place of `A*a`"),
    ("output o: [m; 3] = A*S*a;", "`S` leads to components in space, but `A` turns vectors with components along the axes of `A`; write `transpose(A)*S`"),
    ("output o: [m; 3] = S*Q*a;", "`Q` leads to components along the axes of `A`, but `S` turns vectors with components along the axes of `S`; write `A*Q`"),
    ("output o: [m; 3] = Q*A*a;", "`A` leads to components in space, but `Q` turns vectors with components along the axes of `Q`; write `A*Q`"),
    ("output o: [rad/s; 3] = transpose(A)*angular_velocity(A) - transpose(S)*angular_velocity(S);", "`transpose(S)*angular_velocity(S)` has components along the axes of `S`, but `transpose(A)*angular_velocity(A)` has components along the axes of `A`; write `transpose(A)*angular_velocity(S)`, or `transpose(S)*angular_velocity(A)` in place of `transpose(A)*angular_velocity(A)`"),
    ("output o: [m; 3] = x + Q*a;", "`Q*a` has components along the axes of `A`, but `x` has components in space; write `A*Q*a`, or `transpose(A)*x` in place of `x`"),
    ("torque Q = m*g*(A*a);", "`m*g*(A*a)` has components in space, but a torque on `Q` has components along the axes of `A`; write `transpose(A)*m*g*(A*a)`"),
    ("dissipation = m*sqrt(g*|a|^3)*|angular_velocity(G) - transpose(G)*angular_velocity(G)|^2;", "`transpose(G)*angular_velocity(G)` has components along the axes of `G`, but `angular_velocity(G)` has components in space; write `angular_velocity(G)`, or `transpose(G)*angular_velocity(G)` in place of `angular_velocity(G)`"),
    ("output o: [m; 3] = G*G*a;", "`G` leads to components in space, but `G` turns vectors with components along the axes of `G`; write `G`"),
    ("output o: [m; 3] = x + transpose(G)*x;", "`transpose(G)*x` has components along the axes of `G`, but `x` has components in space; write `x`, or `transpose(G)*x` in place of `x`"),
];

/// Whole blocks, some of which say nothing else about the frames.
#[rustfmt::skip]
const WHOLE: &[(&str, &str)] = &[
    ("struct S { a: [m; 3], m: kg, g: m/s^2 } coordinate A: rotation; coordinate C: rotation; let Q = A*transpose(C); kinetic = m/2*(|dot(A*a)|^2 + |dot(C*a)|^2); potential = m*g*height(A*a); output o: [m; 3] = A*a + C*a;", "`C*a` has components to which `C` leads, but `A*a` has components in space; write `A*a`, or `C*a` in place of `A*a`"),
    ("struct S { B: solid, g: m/s^2 } coordinate R: rotation; let w = angular_velocity(R); kinetic = inner(w, B.inertia*w)/2; potential = B.mass*g*height(R*B.center);", "`w` has components in space here, but `B` has components along the axes of `R` elsewhere; write `transpose(R)*w`"),
    ("struct S { B: solid, g: m/s^2 } coordinate R: rotation; kinetic = integral(p in B, |dot(R*p)|^2)/2; potential = integral(p in B, g*height(p));", "`p` has components in space here, but `B` has components along the axes of `R` elsewhere; write `R*p`"),
    ("struct S { m: kg, a: [m; 3], c: N*m*s } driven P: rotation; coordinate R: rotation; kinetic = m/2*|dot(R*a)|^2 + m*|a|^2/9*|angular_velocity(R)|^2; potential = -m*inner(R*a, P*a)/t^2; dissipation = c/2*|transpose(R)*angular_velocity(R) - transpose(P)*angular_velocity(P)|^2;", "`transpose(P)*angular_velocity(P)` has components along the axes of `P`, but `transpose(R)*angular_velocity(R)` has components along the axes of `R`; write `transpose(R)*angular_velocity(P)`, or `transpose(P)*angular_velocity(R)` in place of `transpose(R)*angular_velocity(R)`"),
    ("struct S { m: kg, J: [kg*m^2; 3, 3] } coordinate x: [m; 3]; coordinate R: rotation; input F: [N; 3]; let W = transpose(R)*angular_velocity(R); kinetic = m/2*|dot(x)|^2 + inner(W, J*W)/2; force x = transpose(R)*F; torque R = R*cross([1, 0, 0], F);", "`F` has components in space, but `[1, 0, 0]` has components along the axes of `R`; write `transpose(R)*F`, or `R*[1, 0, 0]` in place of `[1, 0, 0]`"),
    ("struct S { m: kg, J: [kg*m^2; 3, 3], τ: N*m } coordinate R: rotation; let W = transpose(R)*angular_velocity(R); kinetic = inner(W, J*W)/2; torque R = τ*transpose(R)*[sin(t), 0, 0];", "`τ*transpose(R)*[sin(t), 0, 0]` has components along the axes of `R`, but a torque on `R` has components in space; write `R*τ*transpose(R)*[sin(t), 0, 0]`"),
    ("struct S { J: kg*m^2 } coordinate A: rotation; coordinate S: rotation; kinetic = J/2*(|angular_velocity(A)|^2 + |angular_velocity(S)|^2); output o: [rad/s; 3] = angular_velocity(A) - transpose(S)*angular_velocity(S);", "`transpose(S)*angular_velocity(S)` has components along the axes of `S`, but `angular_velocity(A)` has components in space; write `angular_velocity(S)`, or `transpose(S)*angular_velocity(A)` in place of `angular_velocity(A)`"),
    ("struct S { B: solid, g: m/s^2 } coordinate α: rad; coordinate β: rad; let A = rotation([0, 0, 1], α)*rotation([1, 0, 0], β); let w = angular_velocity(A); kinetic = inner(w, B.inertia*w)/2; potential = B.mass*g*height(A*B.center);", "`w` has components in space here, but `B` has components along the axes of `A` elsewhere; write `transpose(A)*w`"),
    ("struct S { m: kg, l: m, g: m/s^2 } coordinate R[2]: rotation; let y[k in 0..2] = sum(j in 0..=k, l*R[j]*[0, 0, 1]); kinetic = sum(k in 0..2, m/2*|dot(y[k])|^2 + m*l^2/9*|transpose(R[0])*angular_velocity(R[k])|^2); potential = sum(k in 0..2, m*g*height(y[k])); output o[k in 0..2]: [m; 3] = transpose(R[k])*y[k] + y[0];", "`y[0]` has components in space, but `transpose(R[k])*y[k]` has components along the axes of `R[0]`; write `transpose(R[0])*y[0]`, or `R[0]*transpose(R[k])*y[k]` in place of `transpose(R[k])*y[k]`"),
    ("struct S { m: kg, g: m/s^2, a: [m; 3] } coordinate x: [m; 3]; coordinate R: rotation; kinetic = m/2*|dot(x) + dot(R*a)|^2 + m/2*|dot(x)|^2 + m*|a|^2/9*|angular_velocity(R)|^2; potential = m*g*height(x + R*a) + m*g*height(transpose(R)*x);", "`transpose(R)*x` has components along the axes of `R`, but a height is a component in space; write `height(x)`, or `inner([0, 0, 1], transpose(R)*x)`"),
];

#[test]
fn components_of_two_frames_are_not_mixed() {
    for (block, cases) in [(BODY, OF_A_BODY), (BODIES, OF_BODIES), ("", WHOLE)] {
        for (statements, expected) in cases {
            let source = format!("{block} {statements}");
            assert_eq!(messages(&source), [*expected], "{statements}");
        }
    }
}

/// Blocks in which every vector has the components that are needed.
#[rustfmt::skip]
const SOUND: &[(&str, &str)] = &[
    ("a bone whose attitude is relative", "struct S { m: kg, g: m/s^2, J: [kg*m^2; 3, 3], a: [m; 3], u: N*m } driven P: rotation; coordinate Q: rotation; let w = angular_velocity(P) + P*angular_velocity(Q); let W = transpose(P*Q)*w; let y = P*(a + Q*a); kinetic = m/2*|dot(y)|^2 + inner(W, J*W)/2; potential = m*g*height(y); torque Q = -u*(Q*[1, 0, 0]);"),
    ("the same by rates alone", "struct S { m: kg, g: m/s^2, J: [kg*m^2; 3, 3], a: [m; 3] } driven P: rotation; coordinate Q: rotation; let W = transpose(Q)*(transpose(P)*angular_velocity(P) + angular_velocity(Q)); kinetic = inner(W, J*W)/2; potential = m*g*height(P*(a + Q*a));"),
    ("bones in series, each in space", "struct S { m: kg, g: m/s^2, a: [m; 3] } coordinate R[3]: rotation; let y[k in 0..3] = sum(j in 0..=k, R[j]*a); kinetic = sum(k in 0..3, m/2*|dot(y[k])|^2 + m*|a|^2/9*|angular_velocity(R[k])|^2); potential = sum(k in 0..3, m*g*height(y[k])); torque transpose(R[0])*R[1] = m*g*a;"),
    ("bones in series, each relative to the one before", "struct S { B: solid, g: m/s^2, a: [m; 3] } coordinate Q[2]: rotation; let A[k in 0..2] = product(j in 0..=k, Q[j]); let y[k in 0..2] = sum(j in 0..k, A[j]*a); kinetic = sum(k in 0..2, integral(p in B, |dot(y[k] + A[k]*p)|^2)/2); potential = sum(k in 0..2, integral(p in B, g*height(y[k] + A[k]*p)));"),
    ("bodies that share a solid", "struct S { B: solid, g: m/s^2, a: [m; 3] } coordinate x[2]: [m; 3]; coordinate R[2]: rotation; let W[k in 0..2] = transpose(R[k])*angular_velocity(R[k]); kinetic = sum(k in 0..2, B.mass/2*|dot(x[k])|^2 + inner(W[k], B.inertia*W[k])/2); potential = sum(k in 0..2, B.mass*g*height(x[k] + R[k]*B.center)); constraint hinge: x[0] + R[0]*a = x[1] + R[1]*a;"),
    ("Foucault's pendulum", "struct S { m: kg, k: N/m, g: m/s^2, r: [m; 3] } driven P: rotation; coordinate u: [m; 3]; kinetic = m/2*|dot(P*(r + u))|^2; potential = m*g*height(u) + k/2*|u|^2; output seen: [m; 3] = P*u;"),
    ("Foucault's pendulum by the rates of the earth", "struct S { m: kg, k: N/m, g: m/s^2, n: [1; 3], f: rad/s } coordinate u: [m; 3]; let E = rotation(n, f*t); let w = transpose(E)*angular_velocity(E); kinetic = m/2*|dot(u) + cross(w, u)|^2; potential = m*g*height(u); output seen: [m; 3] = E*u;"),
    ("a Dzhanibekov body", "struct S { B: solid } coordinate R: rotation; let W = transpose(R)*angular_velocity(R); let L = B.inertia*W; kinetic = inner(W, L)/2; output seen: [J*s; 3] = R*L; output Euler: [J; 3] = B.inertia*dot(W) + cross(W, L);"),
    ("a satellite with wheels", "struct S { B: solid, J: kg*m^2, n: [1; 3] } coordinate R: rotation; coordinate φ[2]: rad; input u: [N*m; 2]; let W = transpose(R)*angular_velocity(R); kinetic = inner(W, B.inertia*W)/2 + J/2*(|W + n*φ̇[0]|^2 + |W + [1, 0, 0]*φ̇[1]|^2); force φ[k in 0..2] = u[k]; output total: [J*s; 3] = R*(B.inertia*W + J*n*φ̇[0]) + J*R*[1, 0, 0]*φ̇[1];"),
    ("a gyroscope in gimbals", "struct S { ring: solid, B: solid, g: m/s^2 } coordinate α: rad; coordinate β: rad; coordinate γ: rad; let outer = rotation([0, 0, 1], α); let inside = outer*rotation([1, 0, 0], β); let A = inside*rotation([0, 0, 1], γ); let w = transpose(inside)*angular_velocity(inside); let W = transpose(A)*angular_velocity(A); kinetic = inner(w, ring.inertia*w)/2 + inner(W, B.inertia*W)/2; potential = g*B.mass*height(A*B.center);"),
    ("a wheel that is steered", "struct S { B: solid, r: m, g: m/s^2 } coordinate x: [m; 3]; coordinate ψ: rad; coordinate lean: rad; coordinate δ: rad; coordinate φ: rad; let F = rotation([0, 0, 1], ψ)*rotation([1, 0, 0], lean); let H = F*rotation([0, 0, 1], δ); let A = H*rotation([0, 1, 0], φ); let w = angular_velocity(A); let W = transpose(A)*w; kinetic = B.mass/2*|dot(x)|^2 + inner(W, B.inertia*W)/2 + B.mass*r^2/9*|angular_velocity(F)|^2; potential = B.mass*g*height(x); constraint roll: dot(x) = cross(w, r*F*[0, 0, 1]);"),
    ("one angle in several joints", "struct S { m: kg, g: m/s^2, a: [m; 3], n: [1; 3] } coordinate φ: rad; coordinate R: rotation; let F = rotation(n, φ); let G = rotation([1, 0, 0], φ); let y = R*(a + F*(a + G*(a + F*a))); let z = R*(a + transpose(F)*a) - R*F*F*G*F*a; kinetic = m/2*(|dot(y)|^2 + |dot(z)|^2) + m*|a|^2/9*|angular_velocity(R*F)|^2; potential = m*g*(height(y) + height(z));"),
    ("one tilt of two bodies", "struct S { m: kg, g: m/s^2, a: [m; 3], n: [1; 3], α: rad } coordinate R: rotation; coordinate Q: rotation; let T = rotation(n, α); let A = R*T; let B = Q*T; let y = A*a + B*a; kinetic = m/2*|dot(y)|^2 + m*|a|^2/9*(|angular_velocity(A)|^2 + |angular_velocity(B)|^2); potential = m*g*height(y + T*a);"),
    ("a direction in space and of the body", "struct S { J: kg*m^2, k: N*m, n: [1; 3] } coordinate R: rotation; driven b: [1; 3]; let e = R*n; kinetic = J/2*|angular_velocity(R)|^2; potential = -k*inner(n, e) - k*inner(b, e); torque R = k*cross(e, n); output lit: 1 = inner(transpose(R)*b, n);"),
    ("a turn about an axis of the body in space", "struct S { m: kg, g: m/s^2, a: [m; 3] } coordinate φ: rad; coordinate R: rotation; let Q = rotation(R*[0, 0, 1], φ)*R; let y = R*a + Q*a; kinetic = m/2*|dot(y)|^2 + m*|a|^2/9*|angular_velocity(Q)|^2 + m*|a|^2/7*|angular_velocity(R)|^2; potential = m*g*height(y);"),
    ("a turn in space after another", "struct S { m: kg, g: m/s^2, a: [m; 3] } coordinate φ: rad; coordinate R: rotation; let Q = rotation([0, 0, 1], φ)*R; let y = R*a + Q*a; kinetic = m/2*|dot(y)|^2 + m*|a|^2/9*|angular_velocity(Q)|^2 + m*|a|^2/7*|angular_velocity(R)|^2; potential = m*g*height(y);"),
    ("a rotation that leads from space to the body", "struct S { B: solid, m: kg, g: m/s^2, F: [N; 3], c: N*m*s } coordinate x: [m; 3]; coordinate Q: rotation; let W = -angular_velocity(Q); kinetic = m/2*|dot(x)|^2 + inner(W, B.inertia*W)/2; potential = m*g*height(x + transpose(Q)*B.center); force x = transpose(Q)*F; torque transpose(Q) = -c*transpose(Q)*W;"),
    ("a point that moves along the axes of a body", "struct S { m: kg, k: N/m, c: kg/s, g: m/s^2, a: [m; 3] } coordinate x: [m; 3]; coordinate R: rotation; coordinate s: [m; 3]; let y = x + R*(a + s); kinetic = m/2*(|dot(x)|^2 + |dot(y)|^2) + m*|a|^2/9*|angular_velocity(R)|^2; potential = k/2*|s|^2 + m*g*height(y); force s = -c*dot(s); output speed: [m/s; 3] = R*dot(s) + cross(angular_velocity(R), R*s);"),
    ("wind and thrust", "struct S { m: kg, J: kg*m^2, c: kg/s, D: [kg/s; 3, 3], l: m } coordinate x: [m; 3]; coordinate R: rotation; driven wind: [m/s; 3]; input thrust: [N; 3]; let v = transpose(R)*(dot(x) - wind); kinetic = m/2*|dot(x)|^2 + J/2*|angular_velocity(R)|^2; force x = R*thrust - R*(D*v) - c*(dot(x) - wind); torque R = R*[l*c*v.x, 0, 0];"),
    ("an accelerometer", "struct S { m: kg, J: kg*m^2, g: m/s^2 } coordinate x: [m; 3]; coordinate R: rotation; kinetic = m/2*|dot(x)|^2 + J/2*|angular_velocity(R)|^2; potential = m*g*height(x); output felt: [m/s^2; 3] = transpose(R)*(dot(dot(x)) + [0, 0, g]); output rates: [rad/s^2; 3] = dot(transpose(R)*angular_velocity(R));"),
    ("an attitude on a mount of outputs", "struct S { J: kg*m^2, k: N*m, n: [1; 3] } driven P: rotation; coordinate Q: rotation; kinetic = J/2*|angular_velocity(Q)|^2; potential = k*inner(n, Q*[1, 0, 0]); output seen: [1; 3] = P*Q*n;"),
    ("a hinge", "struct S { B: solid, g: m/s^2, n: [1; 3] } coordinate φ: rad; let F = rotation(n, φ); let w = angular_velocity(F); kinetic = inner(w, B.inertia*w)/2; potential = g*integral(p in B, height(F*p)); torque F = -B.mass*g*B.center; output W: [rad/s; 3] = transpose(F)*w;"),
    ("a ball by rates in space", "struct S { B: solid, r: m } coordinate x: [m; 3]; coordinate R: rotation; let w = angular_velocity(R); kinetic = B.mass/2*|dot(x)|^2 + inner(w, B.inertia*w)/2; constraint roll: dot(x) = cross(w, [0, 0, r]); output pull: [N; 3] = transpose(R)*reaction(roll);"),
    ("legs around a platform", "struct S { B: solid, k: N/m, r: m, h: m, g: m/s^2 } coordinate x: [m; 3]; coordinate R: rotation; let T[k in 0..6] = rotation([0, 0, 1], k*π/3); let leg[k in 0..6] = x + R*T[k]*[r, 0, 0] - T[k]*[2*r, 0, 0]; kinetic = integral(p in B, |dot(x + R*p)|^2)/2; potential = sum(i in 0..6, k/2*(|leg[i]| - h)^2) + integral(p in B, g*height(x + R*p));"),
    ("arms around a base", "struct S { m: kg, r: m, g: m/s^2 } coordinate θ[3]: rad; let T[k in 0..3] = rotation([0, 0, 1], 2*k*π/3); let arm[k in 0..3] = T[k]*rotation([0, 1, 0], θ[k]); let y[k in 0..3] = T[k]*[r, 0, 0] + arm[k]*[r, 0, 0]; kinetic = sum(k in 0..3, m/2*|dot(y[k])|^2); potential = sum(k in 0..3, m*g*height(y[k])); constraint plate: |y[0] - y[1]| = r;"),
    ("the deck of a ship", "struct S { m: kg, g: m/s^2, n: [1; 3] } driven s: [m; 3]; driven P: rotation; coordinate x: [m; 3]; let u = transpose(P)*(x - s); kinetic = m/2*|dot(x)|^2; potential = m*g*height(x); limit deck: u.z >= 0, restitution = 0; output side: m = inner(u, n); output sliding: [m/s; 3] = dot(u);"),
    ("functions to and from a body", "struct S { m: kg, J: kg*m^2, k: N/m, a: [m; 3] } coordinate x: [m; 3]; coordinate R: rotation; let world(u) = x + R*u; let own(u) = transpose(R)*(u - x); let spin(A) = transpose(A)*angular_velocity(A); kinetic = m/2*|dot(world(a))|^2 + m/2*|dot(x)|^2 + J/2*|spin(R)|^2; potential = k/2*|world(a)|^2 + k/2*|own([0, 0, 0])|^2 + k/2*|own(world(a) + a)|^2;"),
    ("a field that turns", "struct S { J: kg*m^2, k: N*m, f: rad/s } coordinate R: rotation; let b = [cos(f*t), sin(f*t), 0]; kinetic = J/2*|angular_velocity(R)|^2; potential = -k*inner(b, R*[0, 0, 1]); torque R = k*cross(R*[0, 0, 1], b); output seen: [1; 3] = transpose(R)*b;"),
];

#[test]
fn blocks_with_the_right_components_are_accepted() {
    for (what, block) in SOUND {
        assert_eq!(messages(block), [""; 0], "{what}");
    }
}

/// A tree of frames, the first of which is space. From the frame `k`, the rotation `Rk` leads to an
/// earlier one. Each has a vector `uk`.
struct Tree {
    parents: Vec<usize>,
    random: Random,
}

impl Tree {
    fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        let count = 2 + random.below(3);
        let parents = (0..count).map(|k: usize| random.below(k.max(1))).collect();
        Self { parents, random }
    }

    /// Declares all rotations and vectors. The potential needs each in its frame.
    fn block(&mut self) -> String {
        let mut statements = vec!["coordinate q; kinetic = q̇^2; coordinate u0: [_; 3];".to_owned()];
        let mut heights = vec!["height(u0)".to_owned()];
        for k in 1..self.parents.len() {
            statements.push(format!("coordinate u{k}: [_; 3];"));
            statements.push(match self.random.below(3) {
                0 => format!("coordinate R{k}: rotation;"),
                1 => format!("driven R{k}: rotation;"),
                _ => format!(
                    "coordinate a{k}; coordinate b{k};
                     let R{k} = rotation([0, 1, 0], a{k})*rotation([1, 0, 2], b{k});"
                ),
            });
            let mut chain = format!("R{k}");
            let mut outer = self.parents[k];
            while outer != 0 {
                chain = format!("R{outer}*{chain}");
                outer = self.parents[outer];
            }
            heights.push(format!("height({chain}*(n + u{k}))"));
        }
        let (statements, heights) = (statements.join(" "), heights.join(" + "));
        format!("struct S {{ n: [_; 3] }} {statements} potential = {heights};")
    }

    /// Returns a vector with components in a frame. `certain` excludes those of any frame.
    fn vector(&mut self, frame: usize, depth: usize, certain: bool) -> String {
        let inner: Vec<usize> =
            (1..self.parents.len()).filter(|&k| self.parents[k] == frame).collect();
        match self.random.below(if depth == 0 { 3 } else { 9 }) {
            0 if !certain => {
                self.random.of(&["n", "[1, 2, 3]", "q*n", "[sin(q), 0, t]"]).to_owned()
            }
            1 if !inner.is_empty() => format!("angular_velocity(R{})", self.random.of(&inner)),
            3 | 4 if !inner.is_empty() => {
                let k = self.random.of(&inner);
                format!("R{k}*{}", self.vector(k, depth - 1, certain))
            }
            3 | 5 if frame != 0 => {
                let outer = self.vector(self.parents[frame], depth - 1, certain);
                format!("transpose(R{frame})*{outer}")
            }
            6 => {
                let [a, b] = [certain, false].map(|own| self.vector(frame, depth - 1, own));
                format!("({b} - {a})")
            }
            7 => {
                let [a, b] = [certain, false].map(|own| self.vector(frame, depth - 1, own));
                format!("cross({a}, {b})")
            }
            8 => {
                let other = self.random.below(self.parents.len());
                let [a, b] = [(); 2].map(|()| self.vector(other, depth - 1, false));
                format!("(q*inner({a}, {b})*{})", self.vector(frame, depth - 1, certain))
            }
            _ => format!("u{frame}"),
        }
    }
}

#[test]
fn random_vectors_are_accepted_in_their_frame_and_refused_in_others() {
    for seed in 0..400 {
        let mut tree = Tree::new(seed);
        let block = tree.block();
        let frame = tree.random.below(tree.parents.len());
        let other = (frame + 1 + tree.random.below(tree.parents.len() - 1)) % tree.parents.len();
        let [own, beside] = [frame, frame].map(|frame| tree.vector(frame, 3, true));
        let foreign = tree.vector(other, 3, true);
        let sound = format!("{block} output a: [_; 3] = {own} + {beside};");
        assert_eq!(messages(&sound), [""; 0], "{seed}: {sound}");
        let mixed = format!("{block} output a: [_; 3] = {own} + {foreign};");
        assert_eq!(messages(&mixed).len(), 1, "{seed}: {mixed}");
    }
}
