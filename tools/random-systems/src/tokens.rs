//! Random tokens, and blocks with random changes.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use systems::random::Random;

/// The words of formulas and of mistakes in formulas, between spaces.
const WORDS: &str = r#"
    θ θ̇ ẋ ẍ m L x y k t i π sin cos dot inner sum integral in let struct pub coordinate driven
    kinetic potential lagrangian dissipation force input output body constraint limit restitution
    friction along static reaction rad kg + - * / ^ | = >= ; , : . .. ..= 0 1 2 5 1.5 2x 1e400
    1e-40 99999999999999999999 10000000000000000000000
    ^100000000000000000000000000000000000000 ^2 ^(1/2) ^-1 "a" 'a' # ! ? @ < > & _ __m m·g type
    () [] {}
"#;

/// Blocks without mistakes.
pub const BLOCKS: &[&str] = &[
    "::p; pub struct M { m: kg, L: m, g: m/s^2 = 9.81, } coordinate θ: rad; driven x: [m; 2]; let y = L * [sin(θ), -cos(θ)]; kinetic = m/2 * |ẋ + ẏ|^2; potential = m*g * (height(x) + height(y));",
    "::p; struct C { m: [kg; 3], l: [m; 3], g } coordinate θ[3]: rad; let y[k in 0..3] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]); kinetic = sum(k in 0..3, m[k]/2*|ẏ[k]|^2); potential = sum(k in 0..3, m[k]*g*height(y[k])); dissipation = θ̇[0]^2; force θ[1] = sin(t);",
    "::p; struct C { c: [m; 2], I: kg*m^2 } coordinate θ; let r(p) = cis(θ)*p; lagrangian = I/2*θ̇^2 - height(r(c)) + max(0, θ - 1)^2 - exp(i*θ).x;",
    "::p; struct A { m: kg, L: m, C: F } coordinate θ[2]: rad; driven x: [m; 2]; input u: N; input f: [N; 2]; let y = x + L*cis(θ[0]); let a = dot(ẏ); kinetic = m/2*|ẏ|^2 + m/2*L^2*θ̇[1]^2; potential = -inner(f, y); dissipation = m/2*θ̇[0]^2*L^2/(1 + t); force θ[1] = u*L; output tip: [m; 2] = y; output load[k in 0..2]: N = k*m*|a| + u*θ̈[k]/|θ̈[0]|; output open = f;",
    "::p; struct V { M: [kg; 3, 3], n: [1; 3] = [0, 0, 1], k: N/m } coordinate x: [m; 3]; coordinate r[2]: [m; 2]; input f: [N; 4]; let y[k in 0..2] = r[k] + [x.z, 0]; kinetic = inner(ẋ, M*ẋ)/2 + inner(n, M*n)/2*(|ẏ[0]|^2 + |ṙ[1]|^2); potential = k/2*|x|^2; force x = f[0]*n; force (r[1] - r[0]).y = f[3]; force y[k in 0..2] = [f[1], k*f[2]];",
    "::p; struct R { m: kg, L: m, μ: 1, F: N, e: 1, g: m/s^2 } coordinate r: [m; 2]; coordinate θ[2]: rad; driven s: m; input u: N; kinetic = m/2*|ṙ|^2 + m/2*L^2*(θ̇[0]^2 + θ̇[1]^2); potential = m*g*r.y; constraint rod: L*θ[0] = r.x; redundant constraint roll: L*θ̇[0] = ṙ.x; limit floor: r.y >= 0, restitution = e, friction = μ along ṙ.x - ṡ, static = 2*μ; limit walls[k in 0..2]: L >= (1 - 2*k)*r.x, restitution = 0; friction joint[k in 0..2]: θ̇[k], force = F*L + L*reaction(walls[k]), static = F*L; friction plate: ṙ, force = abs(u) + μ*reaction(floor); output push: N = reaction(floor) + reaction(floor, friction) + reaction(plate.x) + m*dot(ṙ).y; output pull: N = reaction(rod);",
];

fn word(random: &mut Random) -> &'static str {
    let words: Vec<&str> = WORDS.split_whitespace().collect();
    random.of(&words)
}

/// Returns random tokens.
pub fn soup(random: &mut Random, depth: usize) -> TokenStream {
    let mut tokens = TokenStream::new();
    for _ in 0..random.below(12) {
        if depth < 5 && random.below(6) == 0 {
            let delimiter =
                [Delimiter::Parenthesis, Delimiter::Brace, Delimiter::Bracket, Delimiter::None]
                    [random.below(4)];
            tokens.extend([TokenTree::Group(Group::new(delimiter, soup(random, depth + 1)))]);
        } else if let Ok(word) = word(random).parse::<TokenStream>() {
            tokens.extend(word);
        }
    }
    tokens
}

/// Drops, doubles, swaps or replaces some tokens.
pub fn mutate(tokens: TokenStream, random: &mut Random) -> TokenStream {
    let mut list: Vec<TokenTree> = tokens.into_iter().collect();
    for tree in &mut list {
        if let TokenTree::Group(group) = tree
            && random.below(3) == 0
        {
            *tree = TokenTree::Group(Group::new(group.delimiter(), mutate(group.stream(), random)));
        }
    }
    for _ in 0..=random.below(3) {
        if list.is_empty() {
            break;
        }
        let (a, b) = (random.below(list.len()), random.below(list.len()));
        match random.below(4) {
            0 => drop(list.remove(a)),
            1 => list.insert(a, list[b].clone()),
            2 => list.swap(a, b),
            _ => {
                if let Ok(word) = word(random).parse::<TokenStream>() {
                    list.splice(a..=a, word);
                }
            }
        }
    }
    list.into_iter().collect()
}

/// Replaces some names and numbers by others of the same or another block. The result often parses
/// but rarely has a meaning.
pub fn transplant(tokens: TokenStream, random: &mut Random) -> TokenStream {
    let mut donors = Vec::new();
    leaves(tokens.clone(), &mut donors);
    if let Ok(other) = BLOCKS[random.below(BLOCKS.len())].parse() {
        leaves(other, &mut donors);
    }
    let rarity = 5 + random.below(60);
    transplanted(tokens, &donors, rarity, random)
}

fn leaves(tokens: TokenStream, found: &mut Vec<TokenTree>) {
    for tree in tokens {
        match tree {
            TokenTree::Group(group) => leaves(group.stream(), found),
            TokenTree::Ident(_) | TokenTree::Literal(_) => found.push(tree),
            TokenTree::Punct(_) => {}
        }
    }
}

fn transplanted(
    tokens: TokenStream,
    donors: &[TokenTree],
    rarity: usize,
    random: &mut Random,
) -> TokenStream {
    let other = |tree: TokenTree| match tree {
        TokenTree::Group(group) => TokenTree::Group(Group::new(
            group.delimiter(),
            transplanted(group.stream(), donors, rarity, random),
        )),
        TokenTree::Ident(_) | TokenTree::Literal(_) if random.once_in(rarity) => {
            donors[random.below(donors.len())].clone()
        }
        other => other,
    };
    tokens.into_iter().map(other).collect()
}
