import { byId } from './panel/elements';

/** Opens files: by the panel's button, or dropped anywhere on the page. */
export function enableFiles(given: (file: File) => void): void {
    const input = byId<HTMLInputElement>('file');
    input.addEventListener('change', () => {
        const [file] = input.files ?? [];
        if (file) given(file);
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
        const [file] = event.dataTransfer?.files ?? [];
        if (file) given(file);
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
