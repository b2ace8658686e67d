import { byId } from './panel/elements';
import { say } from './panel/notice';

const MODEL = /\.(obj|ply|stl|off|glb|gltf|3ds)$/i;

/** The files that were chosen together with a model. */
const companions = new WeakMap<File, readonly File[]>();
export const companionsOf = (file: File): readonly File[] => companions.get(file) ?? [];

/** Opens files: by the panel's button, or dropped anywhere on the page. Of several, the page opens the first model. */
export function enableFiles(given: (file: File) => void): void {
    const take = (files: readonly File[]) => {
        const file = files.find(({ name }) => MODEL.test(name)) ?? files[0];
        if (!file) return;
        const others = files.filter((other) => other !== file);
        companions.set(file, others);
        given(file);
        const unused = /\.gltf$/i.test(file.name) ? others.filter(({ name }) => MODEL.test(name)) : others;
        if (unused.length > 0) say(`The page opens one model at a time: ${file.name}, and not ${unused.map(({ name }) => name).join(', ')}.`);
    };
    const input = byId<HTMLInputElement>('file');
    input.addEventListener('change', () => {
        take([...(input.files ?? [])]);
        input.value = ''; // so that the same file can be chosen again
    });
    const sign = byId('drop');
    addEventListener('dragover', (event) => {
        if (!event.dataTransfer?.types.includes('Files')) return;
        event.preventDefault();
        sign.hidden = false;
    });
    addEventListener('dragleave', (event) => {
        if (event.relatedTarget === null) sign.hidden = true; // left the window
    });
    addEventListener('drop', (event) => {
        event.preventDefault();
        sign.hidden = true;
        take([...(event.dataTransfer?.files ?? [])]);
    });
}

/** Offers a file to the visitor for download. */
export function saveAs(name: string, content: Blob): void {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(content);
    link.download = name;
    link.click();
    // By then the browser has read the content.
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export interface NamedMesh {
    name: string;
    vertices: ArrayLike<number>;
    faces: ArrayLike<number>;
}

/** OBJ text of some meshes. Nine digits give each single-precision number back exactly. */
export function objText(meshes: NamedMesh[], notices: string[]): string {
    const lines = notices.map((notice) => `# ${notice}`);
    let first = 1;
    for (const { name, vertices, faces } of meshes) {
        lines.push(`o ${name}`);
        for (let i = 0; i < vertices.length; i += 3) lines.push(`v ${digits(vertices[i])} ${digits(vertices[i + 1])} ${digits(vertices[i + 2])}`);
        for (let i = 0; i < faces.length; i += 3) lines.push(`f ${first + faces[i]} ${first + faces[i + 1]} ${first + faces[i + 2]}`);
        first += vertices.length / 3;
    }
    return `${lines.join('\n')}\n`;
}

const digits = (value: number): string => String(Number(value.toPrecision(9)));
