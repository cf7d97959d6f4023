// Files that are dropped or chosen: a recipe with the images beside it, a folder, or a mesh.
const MESHES = /\.(ply|obj|stl|glb|off|tab|icq|bds|zst|gz)$/i, RECIPES = /\.(json|astro)$/i, IMAGES = /\.png$/i;

const bytesIn = async file => new Uint8Array(await file.arrayBuffer());

// All files of what was dropped, those in folders, too.
export async function droppedFiles(transfer) {
  const entries = [...transfer.items].map(item => item.webkitGetAsEntry && item.webkitGetAsEntry()).filter(Boolean);
  if (entries.length === 0) return [...transfer.files];
  const filesIn = async entry => {
    if (entry.isFile) return [await new Promise((done, failed) => entry.file(done, failed))];
    const reader = entry.createReader(), inside = [];
    for (;;) {
      const some = await new Promise((done, failed) => reader.readEntries(done, failed));
      if (some.length === 0) break;
      inside.push(...some);
    }
    return (await Promise.all(inside.map(filesIn))).flat();
  };
  return (await Promise.all(entries.map(filesIn))).flat();
}

// Images as a core takes them.
export const imagesIn = files => Promise.all(files.map(async file => ({name: file.name, bytes: await bytesIn(file)})));

// What the files hold: {kind: "recipe", bytes, name, images, words}, where the images are files that the recipe may name,
// {kind: "mesh", bytes, name}, or {kind: "none", words}.
export async function sortedFiles(files) {
  const recipes = files.filter(({name}) => RECIPES.test(name)), meshes = files.filter(({name}) => MESHES.test(name));
  if (recipes.length > 0) {
    const images = files.filter(({name}) => IMAGES.test(name));
    // Of several recipes that is taken which is named as an image of a relief is, or else the first.
    const [recipe] = recipes.filter(({name}) => images.some(image => image.name.startsWith(name.replace(/\.\w+$/, ".")))).concat(recipes);
    const words = recipes.length > 1 ? `${recipes.length} recipes were dropped; this is ${recipe.name}` : "";
    return {kind: "recipe", bytes: await bytesIn(recipe), name: recipe.name, images, words};
  }
  if (meshes.length > 0) return {kind: "mesh", bytes: await bytesIn(meshes[0]), name: meshes[0].name};
  const [{name}] = files;
  const remedy = /\.(png|jpe?g|tiff?)$/i.test(name) ? "fit_gabor makes a recipe of a photo" : "drop a recipe (.json, .astro), its folder, or a mesh (.ply, .obj, .stl)";
  return {kind: "none", words: `${name}: is no recipe and no mesh; ${remedy}`};
}
