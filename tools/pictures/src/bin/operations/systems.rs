//! The four systems of the note, and chains of links, written in Cartesian coordinates.

/// Returns the name and the block of each system.
pub(crate) fn all() -> Vec<(String, String)> {
    let note = [
        (
            "simple",
            "struct S { m: kg, L: m, g: m/s^2 } coordinate θ: rad; let y = L*[sin(θ), -cos(θ)]; kinetic = m/2*|ẏ|^2; potential = m*g*height(y);",
        ),
        (
            "moving",
            "struct S { m: kg, L: m, g: m/s^2 } coordinate θ: rad; driven x: [m; 2]; let y = x + L*[sin(θ), -cos(θ)]; kinetic = m/2*|ẏ|^2; potential = m*g*height(y);",
        ),
        (
            "compound",
            "struct S { B: body, g: m/s^2 } coordinate θ: rad; let y(p) = cis(θ)*p; kinetic = integral(p in B, |dot(y(p))|^2)/2; potential = integral(p in B, g*height(y(p)));",
        ),
        (
            "moving_compound",
            "struct S { B: body, g: m/s^2 } coordinate θ: rad; driven x: [m; 2]; let y(p) = x + cis(θ)*p; kinetic = integral(p in B, |dot(y(p))|^2)/2; potential = integral(p in B, g*height(y(p)));",
        ),
    ];
    let note = note.map(|(name, text)| (name.to_owned(), text.to_owned()));
    let chains = (1..=10).chain([16, 32]).map(|n| (format!("chain{n}"), chain(n)));
    note.into_iter().chain(chains).collect()
}

/// Returns a chain of `n` links with all masses and lengths as parameters.
fn chain(n: usize) -> String {
    format!(
        "struct S {{ m: [kg; {n}], l: [m; {n}], g: m/s^2 }} coordinate θ[{n}]: rad; \
         let y[k in 0..{n}] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]); \
         kinetic = sum(k in 0..{n}, m[k]/2*|ẏ[k]|^2); potential = sum(k in 0..{n}, m[k]*g*height(y[k]));"
    )
}
